#pragma once
// Right of way between robots that meet: detour, wait, or make room. Pure functions of what one robot knows.

#include <optional>
#include <span>
#include <vector>

#include "decision/distance_field.hpp"
#include "world/grid.hpp"
#include "world/robot.hpp"

namespace outrider::decision {

/// A team-mate nearby, as seen or as last heard.
struct Neighbour {
  RobotId robot = 0;
  Point position;                ///< [m]
  double radius = 0.0;           ///< [m]
  std::vector<Cell> way;         ///< where it is about to drive, when known
  int priority = 0;              ///< lower goes first
  std::optional<RobotId> asks;   ///< whom it asks to make room
  bool heard = false;            ///< recently: way, priority and question are its own; else they are guesses
  bool stays = false;            ///< at the end of its way
};

/// Shortest paths that keep clear of standing team-mates, and places to make room. Owns its workspace.
class Traffic {
 public:
  Traffic(const GridGeometry& geometry, double radius);

  /// Shortest path (cells, `from` first) from `from` to `to` that touches no neighbour where it stands now; none when all
  /// are longer than `longest` [m]. O(cells within `longest`).
  std::optional<std::vector<Cell>> detour(const Grid<std::uint8_t>& passable, Cell from, Cell to, double longest,
                                          std::span<const Neighbour> neighbours);

  struct Room {
    std::vector<Cell> path;         ///< to a place beside the other's way, own cell first
    std::optional<RobotId> ask;     ///< who stands in between and has to make room first
    bool through_asker = false;     ///< only reachable past the asker itself: the asker has to give way
  };
  /// The nearest place where `asker` can pass on its way without touching this robot. Tries, in this order: around
  /// everybody; through others (who are asked in turn); past the asker itself. Nothing when no such place exists within
  /// 30 m.
  /// If the asker stays where its way ends, places from which there is a way around it to `goal` (where this robot wants
  /// to be in the end) come before all others.
  std::optional<Room> make_room(const Grid<std::uint8_t>& passable, Cell from, const Neighbour& asker,
                                std::span<const Neighbour> neighbours, std::optional<Cell> goal = std::nullopt);

  /// A path to one of the cells within `reach` [m] that can be reached around everybody, the `lot`-th (modulo their number)
  /// by row, then column; `from` itself is one of them.
  std::vector<Cell> stroll(const Grid<std::uint8_t>& passable, Cell from, std::span<const Neighbour> neighbours,
                           double reach, std::size_t lot);

  /// The neighbour that the way runs into first, within `horizon` [m] of the path's beginning.
  const Neighbour* in_the_way(std::span<const Cell> way, std::span<const Neighbour> neighbours, double horizon) const;

 private:
  void look_at(const Grid<std::uint8_t>& passable, Cell around, double reach);
  void block(std::span<const Neighbour> neighbours, std::optional<RobotId> except);
  template <class Visit>
  void near_segment(Point a, Point b, double r, Visit&& visit) const;
  Cell in_window(Cell c) const { return {c.x - low_.x, c.y - low_.y}; }
  std::vector<Cell> on_map(std::vector<Cell> path) const;
  Point mark_way(Point from, std::span<const Cell> way, double gap);
  void mark_way_back(const Grid<std::uint8_t>& passable, Cell from, const Neighbour& asker);
  std::vector<Cell> nearest_clear(Cell from);
  std::optional<Room> room_beside(const Grid<std::uint8_t>& passable, Cell from, const Neighbour& asker,
                                  std::span<const Neighbour> neighbours);

  GridGeometry geometry_;
  double radius_;
  Cell low_;                    // lower left cell of the part of the map that the rest is about
  Grid<std::uint8_t> mask_;     // passable without the neighbours
  Grid<std::uint8_t> on_way_;   // 1 = a robot here would be touched by the passing one
  DistanceField field_;
};

/// Distance from p to the segment a-b [m].
double distance_to_segment(Point p, Point a, Point b);

}  // namespace outrider::decision
