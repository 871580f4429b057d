#include "world_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "maps_module.hpp"
#include "world/error.hpp"
#include "world/nearest_name.hpp"

namespace outrider::app {
namespace {

sim::World read_text_world(const std::filesystem::path& path, std::optional<double> resolution) {
  std::ifstream file(path);
  std::ostringstream text;
  if (!std::filesystem::is_regular_file(path) || !file)
    throw InputError(fmt::format("{}: cannot read the map", path.string()));
  if (!(text << file.rdbuf())) throw InputError(fmt::format("{}: empty; expected an ASCII map", path.string()));
  return sim::parse_world(text.str(), path.string(), resolution.value_or(1.0));
}

}  // namespace

sim::World open_world(const std::string& source, std::optional<double> resolution) {
  const auto names = sim::embedded_worlds();
  if (std::find(names.begin(), names.end(), source) != names.end()) return sim::embedded_world(source);
  const std::filesystem::path path(source);
  if (!std::filesystem::exists(path))
    throw InputError(fmt::format("no world or map file called '{}'{}", source, suggestion(source, names)));
  if (path.extension() == ".txt") return read_text_world(path, resolution);
  slam_glue::LoadedMap loaded = maps_module().load_map(path, {resolution});
  sim::World world;
  world.name = path.stem().string();
  world.provenance = path.filename().string();
  world.map = std::move(loaded.grid);
  for (const Point start : loaded.starts) world.starts.push_back({start.x, start.y, 0.0});
  return world;
}

}  // namespace outrider::app
