#include "explorer/mission_draw.hpp"

#include <fmt/format.h>

#include <numeric>
#include <random>

#include "world/error.hpp"
#include "world/task_set.hpp"

namespace outrider::explorer {

decision::TopoMission draw_mission(decision::TopologicalMap map, int goals, int robots, Starts starts, std::uint64_t seed) {
  const auto places = map.waypoints.size();
  const std::size_t begins = starts == Starts::kApart ? static_cast<std::size_t>(robots) : 1;
  if (static_cast<std::size_t>(goals) + begins > places)
    throw InputError(fmt::format("the map has {} waypoints; {} goals and {} start{} need {}", places, goals, begins,
                                 begins == 1 ? "" : "s", static_cast<std::size_t>(goals) + begins));
  if (goals > TaskSet::kMost) throw InputError(fmt::format("{} goals; expected at most {}", goals, TaskSet::kMost));
  std::mt19937_64 random(seed);
  std::vector<int> order(places);
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t k = 0; k + 1 < places; ++k) std::swap(order[k], order[k + random() % (places - k)]);
  decision::TopoMission mission{std::move(map), {}, {}};
  for (int i = 0; i < robots; ++i)
    mission.robots.push_back({fmt::format("r{}", i + 1), order[starts == Starts::kApart ? static_cast<std::size_t>(i) : 0]});
  mission.goals.assign(order.begin() + static_cast<std::ptrdiff_t>(begins),
                       order.begin() + static_cast<std::ptrdiff_t>(begins) + goals);
  return mission;
}

}  // namespace outrider::explorer
