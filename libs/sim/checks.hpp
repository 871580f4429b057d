#pragma once
// Internal to the room: refuses what cannot be simulated. All throw InputError.

#include "sim/simulator.hpp"

namespace outrider::sim {

void check_options(const SimOptions& options);
void check_robot(const RobotSpec& robot, bool lidar);

}  // namespace outrider::sim
