// A finished grid as one layer of an OctoMap. Built once from the grid: inserting rays takes 30 times longer.

#include <fmt/format.h>
#include <octomap/OcTree.h>

#include <fstream>

#include "slam_glue/map_files.hpp"

namespace outrider::slam_glue {

void save_octomap(const OccupancyGrid& map, const std::filesystem::path& bt, double z) {
  const GridGeometry& g = map.geometry();
  octomap::OcTree tree(g.resolution);
  constexpr bool kLazy = true;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (map[i] == CellState::kUnknown) continue;
    const Point p = g.center(g.cell_at(i));
    tree.updateNode(octomap::point3d(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(z)),
                    map[i] == CellState::kOccupied, kLazy);
  }
  tree.updateInnerOccupancy();
  tree.prune();
  std::ofstream out(bt, std::ios::binary);
  // What writeBinaryConst() does, without its chatter on stderr.
  out << "# Octomap OcTree binary file\n# (feel free to add / change comments, but leave the first line as it is!)\n#\n"
      << "id " << tree.getTreeType() << "\nsize " << tree.size() << "\nres " << tree.getResolution() << "\ndata\n";
  tree.writeBinaryData(out);
  out.flush();
  if (!out) throw std::runtime_error(fmt::format("{}: cannot write the OctoMap", bt.string()));
}

}  // namespace outrider::slam_glue
