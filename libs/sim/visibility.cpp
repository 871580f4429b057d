#include "sim/visibility.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace outrider::sim {
namespace {

constexpr std::uint16_t kSolid = 1U << 8;
constexpr std::array<Cell, 8> kNeighbours{{{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

std::uint8_t neighbour_bit(Cell step) {
  for (std::size_t i = 0; i < kNeighbours.size(); ++i)
    if (kNeighbours[i] == step) return static_cast<std::uint8_t>(1U << i);
  return 0;
}

bool within(Cell offset, double range) {
  return offset.x * offset.x + offset.y * offset.y <= range * range * (1.0 + 1e-12);
}

/// Rows of the parents in the octant 0 <= y <= x <= extent: the parent of (x, y) is (x - 1, parents[x][y]).
/// Of the two cells beside the line, the one whose own way keeps nearer to it; rounding to the nearest alone drifts
/// away by several cells at range 50, this by less than two.
std::vector<std::vector<int>> octant_parents(int extent) {
  std::vector<std::vector<int>> parents(static_cast<std::size_t>(extent) + 1);
  const auto row = [&](int x, int y) -> int& {
    return parents[static_cast<std::size_t>(x)][static_cast<std::size_t>(y)];
  };
  for (int x = 0; x <= extent; ++x) {
    parents[static_cast<std::size_t>(x)].assign(static_cast<std::size_t>(x) + 1, 0);
    for (int y = 0; x > 0 && y <= x; ++y) {
      const int below = y * (x - 1) / x;
      const bool on_line = y * (x - 1) % x == 0;
      int best_deviation = x * x;  // all deviations times x, to stay with integers
      for (int candidate = below; candidate <= below + (on_line ? 0 : 1); ++candidate) {
        int deviation = 0;
        for (int px = x - 1, py = candidate; px > 0 && deviation < best_deviation; py = row(px, py), --px)
          deviation = std::max(deviation, std::abs(py * x - px * y));
        if (deviation < best_deviation) {
          best_deviation = deviation;
          row(x, y) = candidate;
        }
      }
    }
  }
  return parents;
}

/// The same for any offset but the centre, by symmetry.
Cell parent_of(Cell c, const std::vector<std::vector<int>>& octant) {
  const int ax = std::abs(c.x), ay = std::abs(c.y);
  const int major = std::max(ax, ay), minor = std::min(ax, ay);
  int px = major - 1, py = octant[static_cast<std::size_t>(major)][static_cast<std::size_t>(minor)];
  if (ay > ax) std::swap(px, py);
  return {c.x < 0 ? -px : px, c.y < 0 ? -py : py};
}

}  // namespace

VisibilityTree::VisibilityTree(double range_cells, int farthest) {
  const int extent = static_cast<int>(std::min(std::floor(range_cells + 1e-9), static_cast<double>(farthest)));
  const auto octant = octant_parents(extent);
  const GridGeometry disc{.width = 2 * extent + 1, .height = 2 * extent + 1};
  const auto index = [&](Cell offset) { return disc.index({offset.x + extent, offset.y + extent}); };

  std::vector<std::vector<Cell>> children(disc.size());
  for (int y = -extent; y <= extent; ++y)
    for (int x = -extent; x <= extent; ++x)
      if ((x != 0 || y != 0) && within({x, y}, range_cells))
        children[index(parent_of({x, y}, octant))].push_back({x, y});

  std::vector<std::pair<Cell, int>> open{{Cell{}, 0}};  // to be visited, with the parent's index
  while (!open.empty()) {
    const auto [offset, parent] = open.back();
    open.pop_back();
    const int self = static_cast<int>(nodes_.size());
    nodes_.push_back({offset, parent, self + 1});
    for (const Cell child : children[index(offset)]) open.emplace_back(child, self);
  }
  for (std::size_t i = nodes_.size(); i-- > 1;) {
    Node& parent = nodes_[static_cast<std::size_t>(nodes_[i].parent)];
    parent.end = std::max(parent.end, nodes_[i].end);
  }
}

CellSensor::CellSensor(const OccupancyGrid& truth, double range) : geometry_(truth.geometry()) {
  const double range_cells = range / geometry_.resolution;
  const int farthest = std::max(geometry_.width, geometry_.height);
  margin_ = static_cast<int>(std::min(std::ceil(range_cells), static_cast<double>(farthest))) + 1;
  pad(truth);
  const VisibilityTree tree(range_cells, farthest);
  for (const VisibilityTree::Node& node : tree.nodes())
    nodes_.push_back(compiled(node, tree.nodes()[static_cast<std::size_t>(node.parent)].offset, range_cells));
}

void CellSensor::pad(const OccupancyGrid& truth) {
  const GridGeometry padded{.width = padded_width(), .height = geometry_.height + 2 * margin_};
  cells_.assign(padded.size(), kSolid);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Cell c = geometry_.cell_at(i);
    std::uint16_t& bits = cells_[padded.index({c.x + margin_, c.y + margin_})];
    bits = truth[i] == CellState::kFree ? 0 : kSolid;
    for (const Cell step : kNeighbours) {
      const Cell beside{c.x + step.x, c.y + step.y};
      if (truth.contains(beside) && truth[beside] != CellState::kFree)
        bits = static_cast<std::uint16_t>(bits | neighbour_bit(step));
    }
  }
}

CellSensor::Node CellSensor::compiled(const VisibilityTree::Node& from, Cell parent, double range_cells) const {
  const Cell at = from.offset;
  Node node{at.y * padded_width() + at.x, at.y * geometry_.width + at.x, from.end};
  if (at.x != parent.x && at.y != parent.y)
    node.squeeze = static_cast<std::uint8_t>(neighbour_bit({parent.x - at.x, 0}) | neighbour_bit({0, parent.y - at.y}));
  for (const Cell step : kNeighbours) {
    const Cell beside{at.x + step.x, at.y + step.y};
    if (std::abs(beside.x) >= std::abs(at.x) && std::abs(beside.y) >= std::abs(at.y) && within(beside, range_cells))
      node.outward = static_cast<std::uint8_t>(node.outward | neighbour_bit(step));
  }
  return node;
}

template <class Seen>
void CellSensor::sense(Cell from, Seen& seen, std::vector<SeenCell>& out) const {
  const auto report = [&](std::int64_t index, CellState state) {
    const auto i = static_cast<std::size_t>(index);
    if (seen[i]) return;
    seen[i] = true;
    out.push_back({static_cast<std::uint32_t>(i), state});
  };
  const auto here = static_cast<std::int64_t>(geometry_.index(from));
  const std::uint16_t* center = cells_.data() + std::int64_t{from.y + margin_} * padded_width() + from.x + margin_;
  for (std::size_t i = 0; i < nodes_.size();) {
    const Node& node = nodes_[i];
    const std::uint16_t cell = center[node.padded];
    if (cell != 0) {
      if ((cell & kSolid) != 0 || (node.squeeze != 0 && (cell & node.squeeze) == node.squeeze)) {
        i = static_cast<std::size_t>(node.end);
        continue;
      }
      for (unsigned faces = cell & node.outward; faces != 0; faces &= faces - 1) {
        const Cell step = kNeighbours[static_cast<std::size_t>(__builtin_ctz(faces))];
        report(here + node.offset + std::int64_t{step.y} * geometry_.width + step.x, CellState::kOccupied);
      }
    }
    report(here + node.offset, CellState::kFree);
    ++i;
  }
}

template void CellSensor::sense(Cell, std::vector<bool>&, std::vector<SeenCell>&) const;
template void CellSensor::sense(Cell, std::vector<std::uint8_t>&, std::vector<SeenCell>&) const;

}  // namespace outrider::sim
