# outrider_room(NAME PUBLIC ... PRIVATE ...): a static library of libs/NAME/*.cpp, alias outrider::NAME.
# `libs/` is the include root: #include "world/grid.hpp".
function(outrider_room name)
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/libs/${name}/*.cpp")
  if(sources)
    add_library(outrider_${name} STATIC ${sources})
    target_link_libraries(outrider_${name} ${ARGN})
    outrider_warnings(outrider_${name})
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
