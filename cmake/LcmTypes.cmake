# outrider_lcm_types: headers that lcm-gen makes of lcmtypes/. Debian's liblcm-dev has neither a CMake package nor a
# usable lcm.pc; only its header of primitive types is needed (docs/dependencies.md).
find_path(LCM_INCLUDE_DIR lcm/lcm_coretypes.h REQUIRED)
find_program(LCM_GEN lcm-gen REQUIRED)
file(GLOB lcm_files CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/lcmtypes/*.lcm" "${PROJECT_SOURCE_DIR}/lcmtypes/*/*.lcm")
set(lcm_dir "${PROJECT_BINARY_DIR}/lcmtypes")
set(lcm_headers)
foreach(file IN LISTS lcm_files)
  get_filename_component(type "${file}" NAME_WE)
  file(STRINGS "${file}" package REGEX "^package ")
  string(REGEX REPLACE "package (.*);" "\\1" package "${package}")
  list(APPEND lcm_headers "${lcm_dir}/${package}/${type}.hpp")
endforeach()
add_custom_command(OUTPUT ${lcm_headers}
  COMMAND ${CMAKE_COMMAND} -E make_directory "${lcm_dir}"
  COMMAND ${LCM_GEN} -x --cpp-std c++11 --cpp-hpath "${lcm_dir}" ${lcm_files}
  DEPENDS ${lcm_files} VERBATIM)
add_custom_target(outrider_lcm_gen DEPENDS ${lcm_headers})
add_library(outrider_lcm_types INTERFACE)
add_dependencies(outrider_lcm_types outrider_lcm_gen)
target_include_directories(outrider_lcm_types SYSTEM INTERFACE "${lcm_dir}" "${LCM_INCLUDE_DIR}")

# LCM 1.3.1 decodes doubles through pointers to integers: whoever includes a generated header is named here.
foreach(user codec introduction lcm_body wire wire_bundles)
  set_source_files_properties("${PROJECT_SOURCE_DIR}/libs/link/${user}.cpp" PROPERTIES COMPILE_OPTIONS -fno-strict-aliasing)
endforeach()

find_path(SODIUM_INCLUDE_DIR sodium.h REQUIRED)
find_library(SODIUM_LIBRARY sodium REQUIRED)
add_library(outrider_sodium INTERFACE)
target_include_directories(outrider_sodium SYSTEM INTERFACE "${SODIUM_INCLUDE_DIR}")
target_link_libraries(outrider_sodium INTERFACE "${SODIUM_LIBRARY}")
