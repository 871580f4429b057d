// `outrider list`: what there is, one line each.

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench.hpp"
#include "context.hpp"
#include "explorer/coordinator.hpp"
#include "sim/world.hpp"
#include "slam_glue/slam.hpp"

namespace outrider::app {
namespace {

using Lines = std::vector<std::pair<std::string, std::string>>;

Lines lines_of(const std::string& what) {
  Lines lines;
  if (what == "coordinators") {
    for (const auto& info : explorer::coordinators()) lines.emplace_back(info.name, info.one_line);
  } else if (what == "worlds") {
    for (const auto& info : sim::embedded_world_infos()) lines.emplace_back(info.name, info.one_line);
  } else if (what == "benches") {
    for (const auto& info : benches()) lines.emplace_back(info.name, info.one_line);
  } else if (what == "slam") {
    for (const auto& [name, one_line] : slam_glue::slam_methods()) lines.emplace_back(name, one_line);
  }
  return lines;
}

void list(const std::string& what, const Context& ctx) {
  const Lines lines = lines_of(what);
  if (ctx.json) {
    nlohmann::ordered_json document = nlohmann::ordered_json::array();
    for (const auto& [name, text] : lines) document.push_back({{"name", name}, {"about", text}});
    fmt::print("{}\n", document.dump(2));
    return;
  }
  std::size_t width = 0;
  for (const auto& line : lines) width = std::max(width, line.first.size());
  for (const auto& [name, text] : lines) fmt::print("{:<{}}  {}\n", name, width, text);
}

}  // namespace

void add_list(CLI::App& app, Context& ctx) {
  auto what = std::make_shared<std::string>();
  CLI::App* verb = app.add_subcommand("list", "what there is: coordinators, worlds, benches, slam methods");
  verb->add_option("WHAT", *what, "coordinators, worlds, benches or slam")
      ->required()->check(CLI::IsMember({"coordinators", "worlds", "benches", "slam"}));
  add_output_flags(*verb, ctx);
  verb->callback([what, &ctx] { list(*what, ctx); });
}

}  // namespace outrider::app
