#pragma once
// A live team as its messages show it, for whoever only listens: replay of a recording, and the live page.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "explorer/coordinator.hpp"
#include "link/guard.hpp"
#include "world/team_map.hpp"

namespace outrider::explorer {

/// What is known of one robot.
struct OverheardRobot {
  RobotSpec spec;
  std::optional<StatusMessage> status;  ///< the last one
  double heard_s = -1e9;                ///< when anything was last heard of it [s]
  std::vector<TimedPose> trajectory;
  std::optional<TeamMap> said;          ///< what it has reported of the map itself
};

/// Listens to one team. Knows nothing until somebody has introduced itself; then takes everything that the guard lets
/// through. Times are the caller's. Not thread-safe.
class Overheard {
 public:
  /// A payload as LCM delivers it. Of several teams on the air the one of `run` counts; 0: the first that is heard.
  Overheard(std::int32_t run, std::optional<link::TeamKey> key) : run_(run), key_(std::move(key)) {}
  /// The message, when it was for us and new; else null.
  std::shared_ptr<const Message> hear(std::string_view channel, std::span<const std::uint8_t> payload, double t);

  bool introduced() const { return map_.has_value(); }
  const Introduction& introduction() const { return introduction_; }  ///< the first one
  std::int32_t run() const { return run_; }
  const std::map<RobotId, OverheardRobot>& robots() const { return robots_; }
  const TeamMap& map() const { return *map_; }                        ///< everybody's news together
  TeamMap& map() { return *map_; }
  const std::vector<AuctionRecord>& auctions() const { return auctions_; }
  std::uint64_t heard() const { return heard_; }                      ///< messages
  std::uint64_t bytes() const { return bytes_; }
  const link::RejectionCounters& rejections() const { return rejections_; }

 private:
  bool meet(std::string_view channel, std::span<const std::uint8_t> payload);
  void take(RobotId from, const Message& message, double t);
  void note(const Awards& awards, double t);

  std::int32_t run_;
  std::optional<link::TeamKey> key_;
  std::optional<link::Guard> guard_;
  Introduction introduction_;
  std::optional<TeamMap> map_;
  std::map<RobotId, OverheardRobot> robots_;
  std::map<RobotId, std::vector<BidSheet>> sheets_;  // by opener, of its current round
  std::vector<AuctionRecord> auctions_;
  link::RejectionCounters rejections_;
  std::uint64_t heard_ = 0, bytes_ = 0;
};

}  // namespace outrider::explorer
