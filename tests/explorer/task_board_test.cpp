#include "explorer/task_board.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <tuple>

#include "decision/distance_field.hpp"
#include "decision/frontiers.hpp"
#include "support/random_map.hpp"
#include "world/ray.hpp"

namespace outrider::explorer {
namespace {

bool row_major(Cell a, Cell b) { return std::tie(a.y, a.x) < std::tie(b.y, b.x); }

struct Oracle {
  const RobotSpec& spec;
  const OccupancyGrid& map;
  const decision::Passability& passable;

  /// First cells of the pieces of frontier, block by block, by the words of the definition.
  std::vector<Cell> tasks(double spacing) const {
    const GridGeometry& g = map.geometry();
    const int block = std::max(1, static_cast<int>(spacing / g.resolution));
    Grid<int> piece(g, -1);
    std::vector<std::vector<Cell>> pieces;
    const auto flood = [&](Cell from) {
      pieces.push_back({from});
      piece[from] = static_cast<int>(pieces.size());
      for (std::size_t k = 0; k < pieces.back().size(); ++k)
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) {
            const Cell n{pieces.back()[k].x + dx, pieces.back()[k].y + dy};
            if (!decision::is_frontier(map, n) || piece[n] >= 0) continue;
            if (n.x / block != from.x / block || n.y / block != from.y / block) continue;
            piece[n] = static_cast<int>(pieces.size());
            pieces.back().push_back(n);
          }
    };
    for (std::size_t i = 0; i < map.size(); ++i)
      if (decision::is_frontier(map, g.cell_at(i)) && piece[i] < 0) flood(g.cell_at(i));
    decision::FrontierExtractor extractor;
    const auto& clusters = extractor.extract(map);
    std::set<std::uint32_t> small;
    for (const auto& cluster : clusters.clusters)
      if (static_cast<double>(cluster.size()) * g.resolution < spec.radius - 1e-9)
        small.insert(clusters.cells.begin() + cluster.begin, clusters.cells.begin() + cluster.end);
    std::vector<Cell> result;
    for (auto& cells : pieces) {
      if (small.contains(static_cast<std::uint32_t>(g.index(cells.front())))) continue;
      std::sort(cells.begin(), cells.end(), row_major);
      const auto stand = std::find_if(cells.begin(), cells.end(), [&](Cell c) { return passable.passable(c); });
      result.push_back(stand == cells.end() ? cells.front() : *stand);
    }
    std::sort(result.begin(), result.end(), row_major);
    return result;
  }

  std::optional<Cell> stand(Cell task, const std::function<bool(Cell)>& good) const {
    const double reach = static_cast<int>(std::min(spec.range, spec.radius + 2 * map.geometry().resolution) /
                                          map.geometry().resolution);
    std::optional<Cell> best;
    const auto squared = [&](Cell c) { return (c.x - task.x) * (c.x - task.x) + (c.y - task.y) * (c.y - task.y); };
    for (std::size_t i = 0; i < map.size(); ++i) {
      const Cell c = map.geometry().cell_at(i);
      if (squared(c) > reach * reach || !good(c) || !line_of_sight(map, c, task)) continue;
      if (!best || squared(c) < squared(*best)) best = c;
    }
    return best;
  }

  std::vector<BidEntry> entries(Cell at, double spacing) const {
    decision::DistanceField field;
    const Cell source[] = {at};
    field.compute(passable.mask(), source);
    const decision::Footprint footprint(spec.range, map.geometry());
    std::vector<BidEntry> result;
    for (const Cell task : tasks(spacing)) {
      auto place = stand(task, [&](Cell c) { return passable.passable(c); });
      if (!place || !field.reached(*place)) place = stand(task, [&](Cell c) { return field.reached(c); });
      if (!place) continue;
      if (footprint.unseen_area(map, *place) < 0.25 * kPi * spec.radius * spec.radius) continue;  // a left-over
      result.push_back({task, *place, static_cast<float>(footprint.unseen_area(map, *place)),
                        static_cast<float>(field.metres(*place))});
    }
    return result;
  }
};

void expect_same(const std::vector<BidEntry>& got, const std::vector<BidEntry>& expected) {
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t k = 0; k < got.size(); ++k) {
    ASSERT_EQ(got[k].task, expected[k].task) << k;
    ASSERT_EQ(got[k].stand, expected[k].stand) << k;
    ASSERT_EQ(got[k].gain, expected[k].gain) << k;
    ASSERT_EQ(got[k].distance, expected[k].distance) << k;
  }
}

/// A board that follows a map as it is discovered, piece by piece.
struct Discovery {
  explicit Discovery(std::uint64_t seed)
      : random(seed),
        truth(test::random_map(seed, 40, 0.5)),
        map(truth.geometry()),
        passable(truth.geometry(), spec().radius),
        board(spec(), map) {}

  static const RobotSpec& spec() {
    static const RobotSpec robot = [] {
      RobotSpec r;
      r.range = 2.5;
      r.radius = 0.6;
      return r;
    }();
    return robot;
  }

  /// A disc around a random cell becomes known.
  void look() {
    const GridGeometry& g = truth.geometry();
    const Cell c = g.cell_at(random() % g.size());
    const int reach = 2 + static_cast<int>(random() % 8);
    std::vector<std::uint32_t> changed;
    for (std::size_t i = 0; i < map.size(); ++i) {
      const Cell n = g.cell_at(i);
      if ((n.x - c.x) * (n.x - c.x) + (n.y - c.y) * (n.y - c.y) > reach * reach || map[i] == truth[i]) continue;
      map[i] = truth[i];
      changed.push_back(static_cast<std::uint32_t>(i));
    }
    const auto mask_changed = passable.update(map, changed);
    board.note_changes(changed, passable, mask_changed);
  }
  Cell somewhere() { return truth.geometry().cell_at(random() % truth.size()); }
  Oracle oracle() const { return {spec(), map, passable}; }

  std::mt19937_64 random;
  OccupancyGrid truth, map;
  decision::Passability passable;
  TaskBoard board;
};

TEST(TaskBoard, ListsEveryTaskThatTheDefinitionNamesWhileTheMapGrows) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Discovery d(seed);
    for (int step = 0; step < 8; ++step) {
      SCOPED_TRACE(step);
      d.look();
      const double spacing = step % 3 == 2 ? 2.0 : 0.5;
      const Cell at = d.somewhere();
      expect_same(d.board.entries(d.passable, at, {.spacing = spacing, .most = 100000}),
                  d.oracle().entries(at, spacing));
      for (const BidEntry& e : d.board.entries(d.passable, at, {.spacing = spacing})) {
        const auto path = d.board.path_to(at, e.stand);
        ASSERT_FALSE(path.empty());
        EXPECT_EQ(path.front(), at);
        EXPECT_EQ(path.back(), e.stand);
      }
    }
  }
}

/// Whatever the others take, up to keep - 1 of the tasks, and however low a bid turns out within its bounds: the best of
/// what is left is on the short list too.
TEST(TaskBoard, AShortListHoldsTheBestOfTheLongOne) {
  const auto most = [](const BidEntry& e) { return (e.gain + 1.0) / (e.distance + 0.1); };
  const auto least = [](const BidEntry& e) { return (0.8 * e.gain + 0.5) / (e.distance + 0.1); };
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Discovery d(seed);
    for (int step = 0; step < 8; ++step) {
      d.look();
      const Cell at = d.somewhere();
      const TaskGrain everything{.spacing = 0.5, .most = 100000};
      TaskGrain few{.spacing = 0.5, .least_bid = least, .most_bid = most, .keep = 1 + d.random() % 4};
      const auto brief = d.board.entries(d.passable, at, few);
      auto all = d.board.entries(d.passable, at, everything);
      const auto served_elsewhere = [&](const BidEntry& e) {  // known at the end of a search only
        return e.stand != d.oracle().stand(e.task, [&](Cell c) { return d.passable.passable(c); });
      };
      for (std::size_t taken = 0; taken < few.keep && !all.empty(); ++taken) {
        std::vector<double> bids;
        for (const BidEntry& e : all)
          bids.push_back(least(e) + (most(e) - least(e)) * static_cast<double>(d.random() % 1000) / 1000.0);
        const auto best = all.begin() + (std::max_element(bids.begin(), bids.end()) - bids.begin());
        const bool listed = std::any_of(brief.begin(), brief.end(), [&](const auto& e) { return e.task == best->task; });
        EXPECT_TRUE(listed || served_elsewhere(*best)) << "step " << step;
        all.erase(best);
      }
    }
  }
}

TEST(TaskBoard, WhatWasLookedAtInVainIsNotOfferedAgainFromThere) {
  std::size_t given_up = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Discovery d(seed);
    for (int step = 0; step < 6; ++step) d.look();
    Cell at = d.somewhere();
    std::set<std::pair<int, int>> stands;
    for (;;) {
      const auto entries = d.board.entries(d.passable, at, {.spacing = 0.5});
      if (entries.empty()) break;
      for (const auto& e : entries) ASSERT_FALSE(stands.contains({e.stand.x, e.stand.y})) << "seed " << seed;
      at = entries.front().stand;
      stands.insert({at.x, at.y});
      d.board.give_up_from(d.passable, at);
    }
    given_up += stands.size();
  }
  EXPECT_GT(given_up, 8U);
}

TEST(TaskBoard, WhereNobodyGetsIsNotOfferedAgain) {
  Discovery d(3);
  for (int step = 0; step < 6; ++step) d.look();
  const Cell at = d.somewhere();
  auto entries = d.board.entries(d.passable, at, {.spacing = 0.5});
  while (!entries.empty()) {
    d.board.give_up_around(entries.front().task, 0.5);
    const auto fewer = d.board.entries(d.passable, at, {.spacing = 0.5});
    ASSERT_LT(fewer.size(), entries.size());
    entries = fewer;
  }
}

}  // namespace
}  // namespace outrider::explorer
