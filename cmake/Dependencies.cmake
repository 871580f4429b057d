# Every third-party library, found once. They are SYSTEM includes: our warnings are about our code.
find_package(Threads REQUIRED)
find_package(ZLIB REQUIRED)
find_package(fmt REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(mrpt-maps 2.5 REQUIRED)
find_package(mrpt-obs REQUIRED)
find_package(mrpt-io REQUIRED)
find_package(mrpt-slam REQUIRED)
find_package(octomap 1.9 REQUIRED)
find_package(Ceres 2 REQUIRED)

add_library(outrider_mrpt INTERFACE)
target_link_libraries(outrider_mrpt INTERFACE mrpt::maps mrpt::obs mrpt::io mrpt::slam)

add_library(outrider_octomap INTERFACE)
target_include_directories(outrider_octomap SYSTEM INTERFACE ${OCTOMAP_INCLUDE_DIRS})
target_link_libraries(outrider_octomap INTERFACE octomap octomath)

# Debian keeps OpenCVConfig.cmake in libopencv-dev, which drags in every module (GTK, Qt, FFmpeg); three are enough.
find_path(OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
add_library(outrider_opencv INTERFACE)
target_include_directories(outrider_opencv SYSTEM INTERFACE "${OPENCV_INCLUDE_DIR}")
foreach(module core imgproc imgcodecs)
  find_library(OPENCV_${module}_LIBRARY opencv_${module} REQUIRED)
  target_link_libraries(outrider_opencv INTERFACE "${OPENCV_${module}_LIBRARY}")
endforeach()
