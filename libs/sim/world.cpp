#include "sim/world.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sim/embedded.hpp"
#include "world/error.hpp"
#include "world/nearest_name.hpp"

namespace outrider::sim {

std::vector<std::string> embedded_worlds() {
  std::vector<std::string> names;
  for (const EmbeddedText& world : embedded_texts()) names.emplace_back(world.name);
  return names;
}

World embedded_world(std::string_view name) {
  for (const EmbeddedText& world : embedded_texts())
    if (world.name == name) return parse_world(world.text, name);
  throw InputError(fmt::format("unknown world '{}'{}", name, suggestion(name, embedded_worlds())));
}

std::vector<WorldInfo> embedded_world_infos() {
  std::size_t longest = 0;
  for (const EmbeddedText& text : embedded_texts()) longest = std::max(longest, text.name.size());
  std::vector<WorldInfo> infos;
  for (const EmbeddedText& text : embedded_texts()) {
    const World world = embedded_world(text.name);
    const GridGeometry& g = world.map.geometry();
    infos.push_back({world.name, world.provenance, g, world.starts.size(), world.team.size(),
                     fmt::format("{:<{}}  {:g} x {:g} m, {} x {} cells of {:g} m, {} starts, {} robots; {}", world.name,
                                 longest, g.width * g.resolution, g.height * g.resolution, g.width, g.height,
                                 g.resolution, world.starts.size(), world.team.size(), world.provenance)});
  }
  return infos;
}

}  // namespace outrider::sim
