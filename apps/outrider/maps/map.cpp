// `outrider map IN OUT`: converts maps; `--info` describes one.

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "maps_module.hpp"
#include "slam_glue/map_files.hpp"
#include "verbs.hpp"
#include "world/error.hpp"
#include "world_source.hpp"

namespace outrider::app {
namespace {

struct Options {
  std::string in;
  std::filesystem::path out;
  std::optional<double> resolution;
  bool info = false;
};

nlohmann::ordered_json describe(const std::string& name, const OccupancyGrid& map) {
  const auto& g = map.geometry();
  const auto area = [&](CellState state) {
    return static_cast<double>(std::count(map.data().begin(), map.data().end(), state)) * g.cell_area();
  };
  return {{"map", name}, {"width_cells", g.width}, {"height_cells", g.height}, {"resolution_m", g.resolution},
          {"origin_m", {g.origin.x, g.origin.y}}, {"width_m", g.width * g.resolution},
          {"height_m", g.height * g.resolution}, {"free_m2", area(CellState::kFree)},
          {"occupied_m2", area(CellState::kOccupied)}, {"unknown_m2", area(CellState::kUnknown)}};
}

void convert(const OccupancyGrid& map, const std::filesystem::path& out, bool force) {
  if (std::filesystem::exists(out) && !force)
    throw InputError(fmt::format("{}: exists; --force replaces it", out.string()));
  if (const auto folder = out.parent_path(); !folder.empty() && !std::filesystem::is_directory(folder))
    throw InputError(fmt::format("{}: no such folder; expected an existing one for OUT", folder.string()));
  const std::string name = out.filename().string();
  const bool ros = name.ends_with(".yaml") || name.ends_with(".yml");
  const bool gridmap = name.ends_with(".gridmap") || name.ends_with(".gridmap.gz");
  if (!ros && !gridmap && !name.ends_with(".bt"))
    throw InputError(fmt::format("{}: unknown map format; expected .yaml, .gridmap, .gridmap.gz or .bt", name));
  try {
    if (ros) slam_glue::save_ros_map(map, out);
    else if (gridmap) slam_glue::save_gridmap(map, out);
    else slam_glue::save_octomap(map, out, 0.0);
  } catch (...) {  // a full disk: nothing half-written stays
    std::error_code ignored;
    std::filesystem::remove(out, ignored);
    if (ros) std::filesystem::remove(std::filesystem::path(out).replace_extension(".pgm"), ignored);
    throw;
  }
}

void run(const Options& o, Context& ctx) {
  if (o.out.empty() && !o.info) throw InputError("map: expected OUT or --info");
  const OccupancyGrid map = open_world(o.in, o.resolution).map;
  if (!o.out.empty()) convert(map, o.out, ctx.force);
  const auto facts = describe(o.in, map);
  if (ctx.json) fmt::print("{}\n", facts.dump(2));
  else if (o.info)
    fmt::print("{}: {} x {} cells of {} m, {:.1f} x {:.1f} m, origin ({}, {}) m\nfree {:.1f} m², occupied {:.1f} m², "
               "unknown {:.1f} m²\n", o.in, map.width(), map.height(), map.geometry().resolution,
               facts["width_m"].get<double>(), facts["height_m"].get<double>(), map.geometry().origin.x,
               map.geometry().origin.y, facts["free_m2"].get<double>(), facts["occupied_m2"].get<double>(),
               facts["unknown_m2"].get<double>());
}

}  // namespace

void add_map(CLI::App& app, Context& ctx) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand(kMap.name, kMap.about);
  verb->add_option("IN", o->in, "world name or map file")->required();
  verb->add_option("OUT", o->out, ".yaml (ROS map_server), .gridmap[.gz] (MRPT) or .bt (OctoMap)");
  verb->add_option("--resolution", o->resolution, "edge of a cell for images, .map and .txt [m]")
      ->check(number_in(1e-3, 1e3))->type_name("M");
  verb->add_flag("--info", o->info, "print size, origin and areas");
  verb->add_flag("--force", ctx.force, "replace OUT");
  add_output_flags(*verb, ctx);
  verb->callback([o, &ctx] { run(*o, ctx); });
}

}  // namespace outrider::app
