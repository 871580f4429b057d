#pragma once
// The small language of --comms.

#include <string>
#include <vector>

#include "link/radio.hpp"
#include "world/robot.hpp"

namespace outrider::app {

/// Comma-separated: ideal, none, range:R[m], los, loss:P, delay:S[s], breaks:NxS[s][@WITHIN], break:T0-T1[:A+B],
/// split:T0-T1:A+B. Throws InputError naming the piece that is off.
link::RadioSpec parse_comms(const std::string& spec, const std::vector<RobotSpec>& team);

}  // namespace outrider::app
