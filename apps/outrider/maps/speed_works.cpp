#include "speed_works.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <queue>
#include <random>

#include "auction/allocation.hpp"
#include "auction/assignment.hpp"
#include "decision/distance_field.hpp"
#include "decision/frontiers.hpp"
#include "decision/passability.hpp"
#include "explorer/mission.hpp"
#include "explorer/scan_mapper.hpp"
#include "team_file.hpp"
#include "world/ray.hpp"
#include "world_source.hpp"

namespace outrider::app {
namespace {

using Do = std::function<void()>;

/// Rooms of 60 x 60 cells with doors in all walls; 0.05 m cells.
OccupancyGrid office(int size) {
  OccupancyGrid map({0.05, {0.0, 0.0}, size, size}, CellState::kFree);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const auto wall = [](int across, int along) { return across % 60 == 0 && (along % 60 < 22 || along % 60 >= 36); };
      if (x == 0 || y == 0 || x + 1 == size || y + 1 == size || wall(x, y) || wall(y, x))
        map[Cell{x, y}] = CellState::kOccupied;
    }
  return map;
}

/// What a team has explored of it: the inside of many overlapping discs, 60 % or so, with a ragged edge.
OccupancyGrid explored(int size) {
  const OccupancyGrid truth = office(size);
  OccupancyGrid map(truth.geometry());
  std::mt19937_64 random(11);
  for (std::size_t k = 0; k < truth.size() / 4000; ++k) {
    const Cell at = truth.geometry().cell_at(random() % truth.size());
    if (at.x > size * 7 / 10) continue;
    for (int dy = -50; dy <= 50; ++dy)
      for (int dx = -50; dx <= 50; ++dx)
        if (const Cell c{at.x + dx, at.y + dy}; dx * dx + dy * dy < 2500 && truth.contains(c)) map[c] = truth[c];
  }
  return map;
}

Do plain_frontiers(std::shared_ptr<const OccupancyGrid> map) {
  return [map] {
    std::vector<bool> seen(map->size(), false);
    std::vector<std::size_t> queue;
    std::size_t clusters = 0;
    for (std::size_t i = 0; i < map->size(); ++i) {
      if (seen[i] || !decision::is_frontier(*map, map->geometry().cell_at(i))) continue;
      ++clusters;
      seen[i] = true;
      for (queue.assign(1, i); !queue.empty();) {
        const Cell c = map->geometry().cell_at(queue.back());
        queue.pop_back();
        for (int k = 0; k < 9; ++k) {
          const Cell n{c.x + k % 3 - 1, c.y + k / 3 - 1};
          if (!map->contains(n) || seen[map->geometry().index(n)] || !decision::is_frontier(*map, n)) continue;
          seen[map->geometry().index(n)] = true;
          queue.push_back(map->geometry().index(n));
        }
      }
    }
    keep(&clusters);
  };
}

Do opencv_frontiers(std::shared_ptr<const OccupancyGrid> map) {
  return [map] {
    const cv::Mat cells(map->height(), map->width(), CV_8U, const_cast<CellState*>(map->data().data()));
    cv::Mat unknown, free, labels, stats, centroids;
    cv::compare(cells, 0, unknown, cv::CMP_EQ);
    cv::compare(cells, 1, free, cv::CMP_EQ);
    cv::dilate(unknown, unknown, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
    cv::bitwise_and(unknown, free, free);
    cv::connectedComponentsWithStats(free, labels, stats, centroids, 8);
    keep(labels.data);
  };
}

Do one_pass(std::shared_ptr<const OccupancyGrid> map) {
  return [map] {
    std::uint8_t all = 0;
    for (const CellState s : map->data()) all = static_cast<std::uint8_t>(all ^ static_cast<std::uint8_t>(s));
    keep(&all);
  };
}

void add_frontiers(std::vector<Work>& works, int size) {
  const std::string name = fmt::format("frontiers, {0} x {0} cells", size);
  const auto map = [size] { return std::make_shared<const OccupancyGrid>(explored(size)); };
  works.push_back({name, "floor", "one pass over the bytes", [=] { return one_pass(map()); }});
  works.push_back({name, "outrider", "all clusters anew", [=] {
                     return [m = map(), extractor = std::make_shared<decision::FrontierExtractor>()] {
                       keep(&extractor->extract(*m));
                     };
                   }});
  works.push_back(
      {name, "opencv", "compare, dilate, connectedComponentsWithStats", [=] { return opencv_frontiers(map()); }});
  works.push_back({name, "plain", "breadth-first search", [=] { return plain_frontiers(map()); }});
}

Do plain_field(std::shared_ptr<const Grid<std::uint8_t>> mask, Cell source) {
  return [mask, source] {
    const GridGeometry& g = mask->geometry();
    using Entry = std::pair<std::uint32_t, std::uint32_t>;
    std::vector<std::uint32_t> d(mask->size(), ~0U);
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    d[g.index(source)] = 0;
    queue.emplace(0U, static_cast<std::uint32_t>(g.index(source)));
    while (!queue.empty()) {
      const auto [at, index] = queue.top();
      queue.pop();
      if (d[index] != at) continue;
      const Cell c = g.cell_at(index);
      for (int k = 0; k < 9; ++k) {
        const Cell n{c.x + k % 3 - 1, c.y + k / 3 - 1};
        if (n == c || !decision::step_allowed(*mask, c, n)) continue;
        const std::uint32_t next = at + (n.x != c.x && n.y != c.y ? 7U : 5U);
        if (next >= d[g.index(n)]) continue;
        d[g.index(n)] = next;
        queue.emplace(next, static_cast<std::uint32_t>(g.index(n)));
      }
    }
    keep(d.data());
  };
}

void add_fields(std::vector<Work>& works, int size) {
  const std::string name = fmt::format("distance field, {0} x {0} cells", size);
  const Cell source{size / 2 - 10, size / 2 - 10};
  const auto mask = [=] {
    auto m = decision::passable_mask(office(size), 0.0);
    m[source] = 1;
    return std::make_shared<const Grid<std::uint8_t>>(std::move(m));
  };
  works.push_back({name, "floor", "copying a field of 16 bits", [=] {
                     const auto from =
                         std::make_shared<std::vector<std::uint16_t>>(static_cast<std::size_t>(size) * size, 1);
                     return [from, to = std::make_shared<std::vector<std::uint16_t>>(from->size())] {
                       std::copy(from->begin(), from->end(), to->begin());
                       keep(to->data());
                     };
                   }});
  works.push_back({name, "outrider", "8 neighbours, Dial's buckets", [=] {
                     return [m = mask(), source, field = std::make_shared<decision::DistanceField>()] {
                       field->compute(*m, {&source, 1});
                       keep(field.get());
                     };
                   }});
  works.push_back({name, "plain", "Dijkstra with a priority queue", [=] { return plain_field(mask(), source); }});
}

void add_scans(std::vector<Work>& works) {
  struct Scene {
    OccupancyGrid map = office(1000);
    std::vector<float> ranges = std::vector<float>(360);
    std::size_t next = 0;
    Point place() {
      std::mt19937_64 random(3 + next++ % 100);
      for (;;) {
        const Cell c = map.geometry().cell_at(random() % map.size());
        if (map[c] == CellState::kFree) return map.geometry().center(c);
      }
    }
  };
  constexpr double kStep = 2.0 * kPi / 360.0, kRange = 20.0;
  const std::string name = "scan of 360 beams, 1000 x 1000 cells";
  works.push_back({name, "floor", "the sines and cosines", [=] {
                     return [s = std::make_shared<Scene>()] {
                       for (std::size_t i = 0; i < s->ranges.size(); ++i) {
                         const double angle = -kPi + static_cast<double>(i) * kStep;
                         s->ranges[i] = static_cast<float>(std::cos(angle) + std::sin(angle));
                       }
                       keep(s->ranges.data());
                     };
                   }});
  works.push_back({name, "outrider", "exact", [=] {
                     return [s = std::make_shared<Scene>()] {
                       cast_scan(s->map, s->place(), -kPi, kStep, s->ranges, kRange);
                       keep(s->ranges.data());
                     };
                   }});
  works.push_back({name, "plain", "cell by cell", [=] {
                     return [s = std::make_shared<Scene>()] {
                       const Point from = s->place();
                       for (std::size_t i = 0; i < s->ranges.size(); ++i) {
                         const double angle = -kPi + static_cast<double>(i) * kStep;
                         walk_ray(s->map.geometry(), from, std::cos(angle), std::sin(angle), kRange,
                                  [&](Cell c, double t) {
                                    s->ranges[i] = static_cast<float>(t);
                                    return s->map[c] != CellState::kOccupied;
                                  });
                       }
                       keep(s->ranges.data());
                     };
                   }});
}

/// Robots and tasks at random places of an open ground; bids with straight distances.
std::vector<BidSheet> sheets(int robots, int tasks, const GridGeometry& g) {
  std::mt19937_64 random(5);
  const auto draw = [&] { return g.cell_at(random() % g.size()); };
  std::vector<Cell> cells;
  for (int p = 0; p < tasks; ++p) cells.push_back(draw());
  std::sort(cells.begin(), cells.end(), [](Cell a, Cell b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
  std::vector<BidSheet> result;
  for (int i = 0; i < robots; ++i) {
    const Point at = g.center(draw());
    BidSheet sheet{.robot = i, .pose = {at.x, at.y, 0.0}, .speed = 1.0 + i % 3, .range = 8.0 + 4.0 * (i % 4)};
    for (const Cell c : cells)
      sheet.entries.push_back({c, c, static_cast<float>(random() % 50), static_cast<float>(distance(at, g.center(c)))});
    result.push_back(std::move(sheet));
  }
  return result;
}

void add_auctions(std::vector<Work>& works) {
  static const GridGeometry ground{1.0, {0.0, 0.0}, 400, 400};
  for (const char* rule : {"ia", "ea", "daa"})
    works.push_back(
        {fmt::format("auction round, {}, 64 robots, 1000 tasks", rule), "outrider", "table, sights and awards", [rule] {
           return [bids = sheets(64, 1000, ground), map = OccupancyGrid(ground, CellState::kFree), rule] {
             const auto clear = [&](Point a, Point b) {
               return line_of_sight(map, ground.cell_of(a), ground.cell_of(b));
             };
             const auction::BidTable table(bids, ground);
             const auto awards = auction::sequential_auction(table, *auction::bid_rule(rule), {}, clear);
             keep(awards.data());
           };
         }});
  works.push_back({"all tasks auctioned, 100 robots, 1000 tasks", "outrider", "for the makespan", [] {
                     return [table = std::make_shared<auction::BidTable>(sheets(100, 1000, ground), ground)] {
                       keep(auction::all_tasks_auction(*table).data());
                     };
                   }});
  for (const auto& [robots, tasks] : {std::pair(10, 100), std::pair(100, 1000)})
    works.push_back(
        {fmt::format("optimal assignment, {} x {}", robots, tasks), "outrider", "shortest augmenting paths", [=] {
           std::vector<double> cost;
           for (const BidSheet& sheet : sheets(robots, tasks, ground))
             for (const BidEntry& entry : sheet.entries) cost.push_back(static_cast<double>(entry.distance));
           return [cost, n = static_cast<std::size_t>(robots)] {
             keep(auction::least_cost_assignment(cost, n, cost.size() / n).data());
           };
         }});
}

/// A whole run: to 95 % of the sparse field with the paper's team, or of the office with lidars.
void add_missions(std::vector<Work>& works) {
  const auto mission = [](const char* world_name, const char* coordinator, bool lidar) {
    auto world = std::make_shared<sim::World>(open_world(world_name, std::nullopt));
    world->map = explorer::solid_map(std::move(world->map));
    const auto team = place_team(*world, usual_team(*world, 4));
    explorer::MissionSettings settings;
    settings.coordinator = coordinator;
    settings.sim.lidar = lidar;
    settings.make_mapper = explorer::make_scan_mapper;
    settings.until = 0.95;
    settings.record_events = false;
    return [world, team, settings] { keep(explorer::run_mission(world->map, team, settings).map.data().data()); };
  };
  for (const char* coordinator : {"daa", "nearest", "hungarian"})
    works.push_back({fmt::format("run: field to 95 %, 4 robots, {}", coordinator), "outrider",
                     "the setting of Dai 2014", [=]() -> Do { return mission("field", coordinator, false); }});
  works.push_back({"run: office to 95 %, 4 robots with lidars, daa", "outrider", "simulation, mapping and planning",
                   [=]() -> Do { return mission("office", "daa", true); }});
}

}  // namespace

void keep(const void* result) { asm volatile("" : : "g"(result) : "memory"); }

std::vector<Work> speed_works() {
  cv::setNumThreads(1);
  std::vector<Work> works;
  add_frontiers(works, 1000);
  add_frontiers(works, 4000);
  add_fields(works, 1000);
  add_scans(works);
  add_auctions(works);
  add_missions(works);
  return works;
}

}  // namespace outrider::app
