#pragma once
// Internal to the auction coordinator: the seller's side of one round, and how sheets are cut for the air.

#include <algorithm>
#include <map>
#include <vector>

#include "world/messages.hpp"

namespace outrider::explorer {

/// A round that this robot has opened and not closed yet.
struct OpenRound {
  RoundId id;
  double since_s = 0.0;
  double repeat_s = 0.0;           ///< when to call for the missing sheets again
  std::vector<RobotId> expected;   ///< ascending
  bool some = false;               ///< only they are asked, not everybody
  std::vector<BidSheet> sheets;    ///< whole ones, the seller's own first
  std::map<RobotId, std::vector<BidSheet>> parts;

  bool heard(RobotId robot) const {
    return std::any_of(sheets.begin(), sheets.end(), [&](const BidSheet& s) { return s.robot == robot; });
  }
  bool complete() const {
    return std::all_of(expected.begin(), expected.end(), [&](RobotId robot) { return heard(robot); });
  }
  RoundOpen call() const;
  /// A part of a sheet has arrived, perhaps again.
  void collect(const BidSheet& part);
};

/// A sheet as it goes on the air: at least one part.
std::vector<BidSheet> cut(BidSheet sheet);

/// The awards of a round, some bidders a message.
std::vector<Awards> cut(const Awards& awards);

}  // namespace outrider::explorer
