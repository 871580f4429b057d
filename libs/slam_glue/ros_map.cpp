#include "slam_glue/ros_map.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>

#include "slam_glue/map_files.hpp"
#include "world/error.hpp"
#include "world/nearest_name.hpp"

namespace outrider::slam_glue {
namespace {

/// Brightness 0..255 and opacity 0..1 of a pixel.
struct Shade {
  double bright = 0.0;
  double alpha = 1.0;
};

/// An image of 1 to 4 channels of 8 bits.
class Picture {
 public:
  explicit Picture(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
      throw InputError(fmt::format("{}: no such image", file.string()));
    try {
      // OpenCV prints its own complaints about damaged images; ours says the same once.
      const auto level = cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
      pixels_ = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
      cv::utils::logging::setLogLevel(level);
      if (pixels_.depth() == CV_16U) pixels_.convertTo(pixels_, CV_8U, 1.0 / 257.0);
    } catch (const cv::Exception&) {
      pixels_.release();
    }
    if (pixels_.empty() || pixels_.depth() != CV_8U)
      throw InputError(fmt::format("{}: not an image that can be read (png, pgm, jpg, bmp)", file.string()));
  }

  /// Calls visit(cell, shade) for each pixel, as a cell with row 0 at the bottom.
  template <class Visit>
  void for_each(Visit&& visit) const {
    const int channels = pixels_.channels(), colours = channels == 2 || channels == 4 ? channels - 1 : channels;
    for (int row = 0; row < pixels_.rows; ++row) {
      const std::uint8_t* p = pixels_.ptr<std::uint8_t>(row);
      for (int x = 0; x < pixels_.cols; ++x, p += channels) {
        int sum = 0;
        for (int c = 0; c < colours; ++c) sum += p[c];
        visit(Cell{x, pixels_.rows - 1 - row},
              Shade{static_cast<double>(sum) / colours, colours < channels ? p[colours] / 255.0 : 1.0});
      }
    }
  }

  GridGeometry geometry(double resolution, Point origin) const {
    return {resolution, origin, pixels_.cols, pixels_.rows};
  }

 private:
  cv::Mat pixels_;
};

/// The value of a required or defaulted key.
template <class T>
T value_of(const YAML::Node& yaml, const std::string& key, const std::string& file, const char* expected,
           std::optional<T> otherwise = std::nullopt) {
  if (!yaml[key]) {
    if (otherwise) return *otherwise;
    std::vector<std::string> keys;
    for (const auto& entry : yaml) keys.push_back(entry.first.as<std::string>(""));
    throw InputError(fmt::format("{}: missing key '{}' ({}){}", file, key, expected, suggestion(key, keys)));
  }
  try {
    return yaml[key].as<T>();
  } catch (const YAML::Exception&) {
    throw InputError(fmt::format("{}:{}: key '{}': expected {}", file, yaml[key].Mark().line + 1, key, expected));
  }
}

/// map_server's settings.
struct RosMap {
  std::filesystem::path image;
  double resolution = 0.0;
  Point origin;
  bool negate = false;
  double occupied = 0.65, free = 0.196;
  std::string mode;
};

RosMap read_settings(const std::filesystem::path& file) {
  const std::string name = file.string();
  YAML::Node yaml;
  try {
    yaml = YAML::LoadFile(name);
  } catch (const YAML::BadFile&) {
    throw InputError(fmt::format("{}: no such file", name));
  } catch (const YAML::Exception& e) {
    throw InputError(fmt::format("{}:{}: not YAML: {}", name, e.mark.line + 1, e.msg));
  }
  if (!yaml.IsMap())
    throw InputError(fmt::format("{}: expected a ROS map_server file with keys image, resolution, origin", name));
  RosMap map;
  map.image = value_of<std::string>(yaml, "image", name, "the name of the image");
  if (map.image.is_relative()) map.image = file.parent_path() / map.image;
  map.resolution = value_of<double>(yaml, "resolution", name, "metres a pixel");
  if (!(map.resolution > 0.0) || !std::isfinite(map.resolution))
    throw InputError(fmt::format("{}: key 'resolution': expected a number above 0", name));
  const auto origin = value_of<std::vector<double>>(yaml, "origin", name, "[x, y, yaw] of the lower-left corner");
  if (origin.size() < 2 || origin.size() > 3 || !std::isfinite(origin[0]) || !std::isfinite(origin[1]))
    throw InputError(fmt::format("{}: key 'origin': expected [x, y, yaw]", name));
  if (origin.size() == 3 && origin[2] != 0.0)
    throw InputError(fmt::format("{}: key 'origin': turned maps are not supported, expected a yaw of 0", name));
  map.origin = {origin[0], origin[1]};
  map.negate = value_of<std::string>(yaml, "negate", name, "0 or 1", "0") != "0" &&
               value_of<std::string>(yaml, "negate", name, "0 or 1") != "false";
  map.occupied = value_of<double>(yaml, "occupied_thresh", name, "a probability", 0.65);
  map.free = value_of<double>(yaml, "free_thresh", name, "a probability", 0.196);
  if (!(map.free >= 0.0 && map.free <= map.occupied && map.occupied <= 1.0))
    throw InputError(fmt::format("{}: expected 0 <= free_thresh <= occupied_thresh <= 1", name));
  map.mode = value_of<std::string>(yaml, "mode", name, "trinary, scale or raw", "trinary");
  if (map.mode != "trinary" && map.mode != "scale" && map.mode != "raw")
    throw InputError(fmt::format("{}: key 'mode': '{}'; expected trinary, scale or raw", name, map.mode));
  return map;
}

/// What map_server makes of a pixel, in three states: what lies between the thresholds is unknown in every mode.
CellState state_of(const RosMap& map, Shade shade) {
  const double bright = map.negate ? 255.0 - shade.bright : shade.bright;
  double occupancy = (255.0 - bright) / 255.0;
  if (map.mode == "raw") {
    if (bright > 100.0) return CellState::kUnknown;
    occupancy = bright / 100.0;
  } else if (shade.alpha < (map.mode == "scale" ? 1.0 : 0.5)) {
    return CellState::kUnknown;
  }
  if (occupancy > map.occupied) return CellState::kOccupied;
  return occupancy < map.free ? CellState::kFree : CellState::kUnknown;
}

}  // namespace

OccupancyGrid load_image_map(const std::filesystem::path& image, double resolution) {
  const Picture picture(image);
  OccupancyGrid map(picture.geometry(resolution, {0.0, 0.0}));
  picture.for_each([&](Cell cell, Shade shade) {
    map[cell] = shade.alpha == 0.0 || shade.bright >= 128.0 ? CellState::kFree : CellState::kOccupied;
  });
  return map;
}

OccupancyGrid load_ros_map(const std::filesystem::path& yaml) {
  const RosMap settings = read_settings(yaml);
  const Picture picture(settings.image);
  OccupancyGrid map(picture.geometry(settings.resolution, settings.origin));
  picture.for_each([&](Cell cell, Shade shade) { map[cell] = state_of(settings, shade); });
  return map;
}

void save_ros_map(const OccupancyGrid& map, const std::filesystem::path& yaml) {
  const GridGeometry& g = map.geometry();
  std::filesystem::path pgm = yaml;
  pgm.replace_extension(".pgm");
  std::string pixels = fmt::format("P5\n{} {}\n255\n", g.width, g.height);
  for (int y = g.height - 1; y >= 0; --y) {
    for (int x = 0; x < g.width; ++x) {
      const CellState state = map[Cell{x, y}];
      pixels += static_cast<char>(state == CellState::kFree ? 254 : state == CellState::kOccupied ? 0 : 205);
    }
  }
  const auto write = [](const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream out(file, std::ios::binary);
    out << bytes << std::flush;
    if (!out) throw std::runtime_error(fmt::format("{}: cannot be written completely", file.string()));
  };
  write(pgm, pixels);
  write(yaml, fmt::format("image: {}\nresolution: {}\norigin: [{}, {}, 0]\nnegate: 0\noccupied_thresh: 0.65\n"
                          "free_thresh: 0.196\n",
                          pgm.filename().string(), g.resolution, g.origin.x, g.origin.y));
}

}  // namespace outrider::slam_glue
