#include "explorer/known_map_views.hpp"

#include <cmath>

namespace outrider::explorer {

Views::Views(const OccupancyGrid& truth, const Grid<std::uint8_t>& passable, double range)
    : passable_(passable), geometry_(truth.geometry()), sensor_(truth, range), marks_(truth.size(), 0) {}

const Leg& Views::leg(Cell from, Cell to) {
  auto [entry, fresh] = legs_.try_emplace(key(from, to));
  if (!fresh) return entry->second;
  const std::vector<Cell> way = field_to(to).path(from);
  for (std::size_t k = 1; k < way.size(); ++k)
    entry->second.push_back({geometry_.resolution * std::hypot(way[k].x - way[k - 1].x, way[k].y - way[k - 1].y),
                             &newly(way[k], way[k - 1])});
  return entry->second;
}

const decision::DistanceField& Views::field_to(Cell to) {
  auto& field = fields_[geometry_.index(to)];
  if (!field) {
    field = std::make_unique<decision::DistanceField>();
    field->compute(passable_, std::vector<Cell>{to});
  }
  return *field;
}

const std::vector<std::uint32_t>& Views::newly(Cell at, Cell before) {
  auto [entry, fresh] = newly_.try_emplace(key(at, before));
  if (!fresh) return entry->second;
  std::vector<SeenCell> old, now;
  if (at != before) sensor_.sense(before, marks_, old);
  sensor_.sense(at, marks_, now);
  for (const SeenCell& cell : old) marks_[cell.index] = 0;
  for (const SeenCell& cell : now) {
    marks_[cell.index] = 0;
    if (cell.state == CellState::kFree) entry->second.push_back(cell.index);
  }
  return entry->second;
}

std::uint64_t Views::key(Cell a, Cell b) const {
  return geometry_.index(a) * static_cast<std::uint64_t>(geometry_.size()) + geometry_.index(b);
}

}  // namespace outrider::explorer
