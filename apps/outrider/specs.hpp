#pragma once
// The small language of --fault, and what it shares with that of --comms (comms_spec.hpp).

#include <string>
#include <vector>

#include "explorer/mission.hpp"
#include "world/robot.hpp"

namespace outrider::app {

/// The parts between the separators; an empty text has none.
std::vector<std::string> split(const std::string& text, char at);
/// Throws InputError, beginning with `where`, when there is no such robot.
RobotId robot_called(const std::string& name, const std::string& where, const std::vector<RobotSpec>& team);

/// "kill:ROBOT@T,revive:ROBOT@T,slow:ROBOT@T:FACTOR,deaf:ROBOT@T0-T1" -> faults by time. Throws InputError naming the piece that is off.
std::vector<explorer::Fault> parse_faults(const std::string& spec, const std::vector<RobotSpec>& team);

}  // namespace outrider::app
