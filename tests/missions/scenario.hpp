#pragma once
// A short random mission, drawn from a number: world, team, radio, faults.

#include <cstdint>
#include <string>
#include <vector>

#include "explorer/mission.hpp"

namespace outrider::test {

struct Scenario {
  OccupancyGrid truth;
  std::vector<RobotSpec> team;
  explorer::MissionSettings settings;
  std::string text;  ///< in words
};

/// The same number gives the same scenario.
Scenario draw_scenario(std::uint64_t number);

struct Problem {
  std::string text;
  bool never = false;  ///< a collision, or two runs that differ: no bad luck excuses it
};

/// What went wrong; empty when nothing did. Runs the scenario twice.
std::vector<Problem> check_scenario(const Scenario& scenario);

/// The true map with start cells (a, b, ...), end cells (A, B, ...), and where somebody alive is wrong about a free cell:
/// '?' where it is unknown to them, 'x' where they take it for a wall.
std::string picture(const Scenario& scenario, const explorer::MissionResult& result);

}  // namespace outrider::test
