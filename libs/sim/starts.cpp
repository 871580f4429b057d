// Where a team may begin.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <queue>
#include <random>
#include <tuple>

#include "sim/walls.hpp"
#include "sim/world.hpp"
#include "world/error.hpp"

namespace outrider::sim {
namespace {

constexpr double kSpare = 0.1;  ///< of the sum of two radii, between robots that were not placed by hand

struct Placed {
  Pose2 pose;
  double radius;
};

bool apart(const std::vector<Placed>& placed, Point p, double radius, double spare) {
  return std::all_of(placed.begin(), placed.end(), [&](const Placed& other) {
    const double least = (other.radius + radius) * (1.0 + spare) - kTouchTolerance;
    return distance(other.pose.position(), p) >= least;
  });
}

/// Visits the cells that a disc can reach from `sources`, nearest by way first, until `visit(cell, source)` is false.
/// 8 neighbours; a diagonal step needs both cells beside it.
template <class Visit>
void spread(const Walls& walls, const GridGeometry& g, const std::vector<Cell>& sources, Visit&& visit) {
  struct Open {
    double way;
    std::size_t cell, source;
    bool operator>(const Open& other) const { return std::tie(way, cell) > std::tie(other.way, other.cell); }
  };
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  std::vector<bool> closed(g.size(), false);
  for (std::size_t i = 0; i < sources.size(); ++i)
    if (g.contains(sources[i])) open.push({0.0, g.index(sources[i]), i});
  while (!open.empty()) {
    const Open at = open.top();
    open.pop();
    if (closed[at.cell]) continue;
    closed[at.cell] = true;
    const Cell c = g.cell_at(at.cell);
    if (walls.passable(c) && !visit(c, at.source)) return;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell next{c.x + dx, c.y + dy};
        if (walls.passable(next) && !closed[g.index(next)] && walls.passable({next.x, c.y}) &&
            walls.passable({c.x, next.y}))
          open.push({at.way + std::hypot(dx, dy), g.index(next), at.source});
      }
  }
}

/// The cells that a disc can reach from `first`, in any order; marks them in `known`.
std::vector<Cell> region_of(const Walls& walls, const GridGeometry& g, Cell first, std::vector<bool>& known) {
  std::vector<Cell> region{first};
  known[g.index(first)] = true;
  for (std::size_t k = 0; k < region.size(); ++k) {
    const Cell c = region[k];
    // A diagonal step needs both cells beside it, so that these four lead everywhere.
    for (const Cell next : {Cell{c.x + 1, c.y}, Cell{c.x - 1, c.y}, Cell{c.x, c.y + 1}, Cell{c.x, c.y - 1}}) {
      if (!walls.passable(next) || known[g.index(next)]) continue;
      known[g.index(next)] = true;
      region.push_back(next);
    }
  }
  return region;
}

/// The passable cell nearest to the middle of the largest region that a disc can drive in.
std::optional<Cell> middle_of_largest_region(const Walls& walls, const GridGeometry& g) {
  std::vector<bool> known(g.size(), false);
  std::vector<Cell> largest;
  for (std::size_t i = 0; i < g.size(); ++i) {
    if (known[i] || !walls.passable(g.cell_at(i))) continue;
    std::vector<Cell> region = region_of(walls, g, g.cell_at(i), known);
    if (region.size() > largest.size()) largest = std::move(region);
  }
  if (largest.empty()) return std::nullopt;
  const Point middle = g.center({g.width / 2, g.height / 2});
  return *std::min_element(largest.begin(), largest.end(), [&](Cell a, Cell b) {
    const double da = distance(g.center(a), middle), db = distance(g.center(b), middle);
    return std::pair(da, g.index(a)) < std::pair(db, g.index(b));
  });
}

/// The start poses of a world, or the middle of its largest region, with their cells.
struct Sources {
  std::vector<Pose2> poses;
  std::vector<Cell> cells;
};

Sources sources_of(const World& world, const Walls& widest) {
  const GridGeometry& g = world.map.geometry();
  Sources sources{world.starts, {}};
  if (sources.poses.empty())
    if (const auto middle = middle_of_largest_region(widest, g))
      sources.poses.push_back({g.center(*middle).x, g.center(*middle).y, 0.0});
  for (const Pose2& pose : sources.poses) sources.cells.push_back(g.cell_of(pose.position()));
  return sources;
}

/// The nearest place, by way of free space, to source `only` (to any, if there is no such) with room for a disc. Cells that
/// are too near to somebody are so for good: `taken` keeps them for the next disc of this radius.
std::optional<Pose2> nearest_place(const Sources& sources, std::size_t only, const Walls& walls, const GridGeometry& g,
                                   const std::vector<Placed>& placed, std::vector<bool>& taken) {
  const bool any = only >= sources.cells.size();
  std::optional<Pose2> pose;
  spread(walls, g, any ? sources.cells : std::vector<Cell>{sources.cells[only]}, [&](Cell c, std::size_t source) {
    if (taken[g.index(c)]) return true;
    const Point p = g.center(c);
    if (apart(placed, p, walls.radius(), kSpare)) pose = Pose2{p.x, p.y, sources.poses[any ? source : only].theta};
    else taken[g.index(c)] = true;
    return !pose;
  });
  return pose;
}

}  // namespace

std::vector<Pose2> spread_starts(const World& world, std::span<const double> radii) {
  std::map<double, Walls> walls;
  for (const double radius : radii) walls.try_emplace(radius, world.map, radius);
  if (radii.empty()) return {};
  const Sources sources = sources_of(world, walls.rbegin()->second);

  std::vector<Placed> placed;
  std::map<double, std::vector<bool>> taken;  // by radius
  for (const auto& [radius, of_radius] : walls) taken[radius].assign(world.map.size(), false);
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const Walls& body_walls = walls.at(radii[i]);
    std::optional<Pose2> pose;
    if (i < world.starts.size()) {
      const Pose2& start = world.starts[i];
      if (!body_walls.fits(start.position()))
        throw InputError(fmt::format("robot {} at ({:g}, {:g}): its start is in a wall or off the map (radius {:g} m)",
                                     i + 1, start.x, start.y, radii[i]));
      if (apart(placed, start.position(), radii[i], 0.0)) pose = start;
    }
    if (!pose) pose = nearest_place(sources, i, body_walls, world.map.geometry(), placed, taken.at(radii[i]));
    if (!pose)
      throw InputError(fmt::format("no room for robot {} of {} (radius {:g} m) near the start poses", i + 1,
                                   radii.size(), radii[i]));
    placed.push_back({*pose, radii[i]});
  }
  std::vector<Pose2> poses;
  poses.reserve(placed.size());
  for (const Placed& robot : placed) poses.push_back(robot.pose);
  return poses;
}

std::vector<Pose2> random_starts(const World& world, std::span<const double> radii, std::uint64_t seed) {
  if (radii.empty()) return {};
  const GridGeometry& g = world.map.geometry();
  const Walls widest(world.map, *std::max_element(radii.begin(), radii.end()));
  const Sources sources = sources_of(world, widest);
  std::vector<Cell> free;
  spread(widest, g, sources.cells, [&](Cell c, std::size_t) {
    free.push_back(c);
    return true;
  });
  std::mt19937_64 random(seed);
  std::vector<Placed> placed;
  std::vector<Pose2> poses;
  for (const double radius : radii) {
    // Cells too near to a robot that stands already are too near for good: they are dropped as they are drawn.
    for (bool found = false; !found;) {
      if (free.empty()) throw InputError(fmt::format("no room for {} robots at random starts", radii.size()));
      std::swap(free[random() % free.size()], free.back());
      const Point p = g.center(free.back());
      free.pop_back();
      found = apart(placed, p, radius, kSpare);
      if (found) placed.push_back({{p.x, p.y, sources.poses.front().theta}, radius});
    }
    poses.push_back(placed.back().pose);
  }
  return poses;
}

}  // namespace outrider::sim
