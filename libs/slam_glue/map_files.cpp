#include "slam_glue/map_files.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "slam_glue/mrpt_grid.hpp"
#include "slam_glue/ros_map.hpp"
#include "slam_glue/text_maps.hpp"
#include "world/error.hpp"

namespace outrider::slam_glue {

LoadedMap load_map(const std::filesystem::path& file, const MapLoadOptions& options) {
  const std::string name = file.string();
  if (options.resolution && !(*options.resolution > 0.0 && std::isfinite(*options.resolution)))
    throw InputError(fmt::format("{}: expected a resolution above 0 m, got {}", name, *options.resolution));
  std::string suffix = file.extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return std::tolower(c); });
  std::error_code error;
  if (!std::filesystem::exists(file, error)) throw InputError(fmt::format("{}: no such file", name));
  if (!std::filesystem::is_regular_file(file, error)) throw InputError(fmt::format("{}: not a file", name));

  if (suffix == ".yaml" || suffix == ".yml") return {load_ros_map(file), {}};
  if (suffix == ".gridmap" || name.ends_with(".gridmap.gz")) return {load_gridmap(file), {}};
  if (suffix == ".dat" || name.ends_with(".dat.gz")) return {load_beesoft(file), {}};
  if (suffix == ".map") return {load_moving_ai(file, options.resolution.value_or(1.0)), {}};
  if (suffix == ".txt") return load_ascii(file, options.resolution.value_or(1.0));
  if (suffix == ".png" || suffix == ".pgm" || suffix == ".jpg" || suffix == ".jpeg" || suffix == ".bmp") {
    if (!options.resolution)
      throw InputError(fmt::format("{}: an image does not say how large a pixel is; give --resolution METRES", name));
    return {load_image_map(file, *options.resolution), {}};
  }
  throw InputError(
      fmt::format("{}: unknown map format; expected .yaml, .png, .pgm, .jpg, .bmp, .gridmap[.gz], .map, .dat[.gz] or .txt", name));
}

}  // namespace outrider::slam_glue
