#pragma once
// The small languages of --fault and --comms.

#include <string>
#include <vector>

#include "explorer/mission.hpp"
#include "world/robot.hpp"

namespace outrider::app {

/// "kill:ROBOT@T,revive:ROBOT@T,slow:ROBOT@T:FACTOR" -> faults by time. Throws InputError naming the piece that is off.
std::vector<explorer::Fault> parse_faults(const std::string& spec, const std::vector<RobotSpec>& team);

/// "ideal" or "none". Throws InputError otherwise.
link::LinkModel parse_comms(const std::string& spec);

}  // namespace outrider::app
