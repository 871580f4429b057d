# outrider_room(NAME PUBLIC ... PRIVATE ...): a static library of libs/NAME/*.cpp, alias outrider::NAME.
# `libs/` is the include root: #include "world/grid.hpp".
# What every room includes is parsed once, in the first room: it was a third of the time of a clean build.
set(outrider_common_headers <algorithm> <array> <cmath> <cstdint> <functional> <limits> <map> <memory> <numeric> <optional>
                            <random> <span> <string> <string_view> <tuple> <utility> <variant> <vector> <fmt/format.h>)
function(outrider_room name)
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/libs/${name}/*.cpp")
  if(sources)
    add_library(outrider_${name} STATIC ${sources})
    target_link_libraries(outrider_${name} ${ARGN})
    outrider_warnings(outrider_${name})
    if(name STREQUAL "world")
      target_precompile_headers(outrider_world PRIVATE ${outrider_common_headers})
    elseif(NOT name STREQUAL "report") # has its own, with JSON
      target_precompile_headers(outrider_${name} REUSE_FROM outrider_world)
    endif()
    target_include_directories(outrider_${name} PUBLIC "${PROJECT_SOURCE_DIR}/libs")
  else() # header-only room
    add_library(outrider_${name} INTERFACE)
    set(links ${ARGN})
    list(TRANSFORM links REPLACE "^(PUBLIC|PRIVATE)$" "INTERFACE")
    target_link_libraries(outrider_${name} ${links})
    target_include_directories(outrider_${name} INTERFACE "${PROJECT_SOURCE_DIR}/libs")
  endif()
  add_library(outrider::${name} ALIAS outrider_${name})
endfunction()

function(outrider_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wshadow
                         -Wno-missing-field-initializers) # designated initialisers leave defaults out on purpose
endfunction()
