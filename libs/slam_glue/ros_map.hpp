#pragma once
// Internal: images and ROS map_server maps behind load_map.

#include <filesystem>

#include "world/grid.hpp"

namespace outrider::slam_glue {

OccupancyGrid load_image_map(const std::filesystem::path& image, double resolution);
OccupancyGrid load_ros_map(const std::filesystem::path& yaml);

}  // namespace outrider::slam_glue
