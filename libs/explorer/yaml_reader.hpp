#pragma once
// Strict reading of small YAML files: every complaint names file, line, key and what was expected.

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "world/error.hpp"
#include "world/geometry.hpp"
#include "world/nearest_name.hpp"

namespace outrider::explorer {

class YamlReader {
 public:
  /// `what` the file is, for the complaint when it cannot be opened: "team file".
  YamlReader(std::filesystem::path path, std::string what) : path_(std::move(path)), what_(std::move(what)) {}

  const std::filesystem::path& path() const { return path_; }

  YAML::Node load() const {
    std::ifstream file(path_);
    if (!file || std::filesystem::is_directory(path_))
      throw InputError(fmt::format("{}: cannot open the {}", path_.string(), what_));
    try {
      return YAML::Load(file);
    } catch (const YAML::Exception& e) {
      throw InputError(fmt::format("{}:{}: {}", path_.string(), e.mark.line + 1, e.msg));
    }
  }

  [[noreturn]] void fail(const YAML::Node& node, const std::string& what) const {
    const YAML::Mark mark = node.Mark();
    throw InputError(mark.is_null() ? fmt::format("{}: {}", path_.string(), what)
                                    : fmt::format("{}:{}: {}", path_.string(), mark.line + 1, what));
  }

  std::string text(const YAML::Node& node, const std::string& what) const {
    if (!node.IsScalar()) fail(node, fmt::format("expected text as {}, not a list or a map", what));
    return node.Scalar();
  }

  /// Refuses a node that is no map, unknown keys, and keys that stand twice.
  void known_keys(const YAML::Node& map, const std::vector<std::string>& keys) const {
    std::vector<std::string> seen;
    for (const auto& pair : map) {
      const std::string key = text(pair.first, "a key");
      if (std::find(keys.begin(), keys.end(), key) == keys.end())
        fail(pair.first, fmt::format("unknown key '{}'{}", key, suggestion(key, keys)));
      if (std::find(seen.begin(), seen.end(), key) != seen.end()) fail(pair.first, fmt::format("key '{}' twice", key));
      seen.push_back(key);
    }
  }

  double number(const YAML::Node& node, const std::string& key, double low, double high, const std::string& unit) const {
    double value = 0.0;
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) || !(value >= low && value <= high))
      fail(node, fmt::format("{}: expected a number from {} to {}{}", key, low, high, unit.empty() ? "" : " " + unit));
    return value;
  }

  bool yes_no(const YAML::Node& node, const std::string& key) const {
    bool value = false;
    if (!node.IsScalar() || !YAML::convert<bool>::decode(node, value))
      fail(node, fmt::format("{}: expected true or false", key));
    return value;
  }

  /// [x, y] or [x, y, theta] in metres and radians.
  Pose2 pose(const YAML::Node& node, const std::string& key) const {
    if (!node.IsSequence() || node.size() < 2 || node.size() > 3)
      fail(node, fmt::format("{}: expected [x, y, theta] in metres and radians", key));
    return {number(node[0], key + " x", -1e6, 1e6, "m"), number(node[1], key + " y", -1e6, 1e6, "m"),
            node.size() == 3 ? wrap_angle(number(node[2], key + " theta", -1e3, 1e3, "rad")) : 0.0};
  }

 private:
  std::filesystem::path path_;
  std::string what_;
};

}  // namespace outrider::explorer
