#pragma once
// "Why did robot 2 go there?": the auction behind a goal, from the events of a run.

#include <span>
#include <string>

#include "report/run_record.hpp"

namespace outrider::report {

/// What robot `robot` was heading for at time `t` [s], and the latest auction round that gave it this task, with all
/// bids for the task and all bids of the robot: {"robot", "t", "goal", "auction", "for_task", "own_bids"}; "goal" is
/// null when it had none, "auction" when no auction was behind it. Bids are {"robot", "task", "gain_m2", "distance_m",
/// "won_by"}.
Json why(std::span<const Json> events, const std::string& robot, double t);

/// The same in words and tables.
std::string why_text(const Json& why);

}  // namespace outrider::report
