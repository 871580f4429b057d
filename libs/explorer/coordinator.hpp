#pragma once
// The seam between a robot and the way its team decides who goes where.

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "auction/allocation.hpp"
#include "decision/dvf.hpp"
#include "decision/passability.hpp"
#include "explorer/task_board.hpp"
#include "link/bus.hpp"
#include "world/messages.hpp"

namespace outrider::explorer {

/// A thing to explore and the place to do it from.
struct Task {
  Cell cell;
  Cell stand;
  friend bool operator==(const Task&, const Task&) = default;
};

/// A team-mate as last heard of.
struct Teammate {
  RobotId robot = 0;
  StatusMessage status;
  double heard_s = 0.0;  ///< when
};

/// The team-mate of that number in a team sorted by robot; null when it is not in it. O(log team).
template <class Team>
auto find_mate(Team& team, RobotId robot) -> decltype(team.data()) {
  const auto mate = std::lower_bound(team.begin(), team.end(), robot,
                                     [](const Teammate& t, RobotId number) { return t.robot < number; });
  return mate != team.end() && mate->robot == robot ? &*mate : nullptr;
}

/// One finished auction round, for the record: every bid, winners and losers.
struct AuctionRecord {
  double t = 0.0;
  RoundId round;
  std::vector<BidSheet> sheets;
  std::vector<Award> awards;
  std::vector<RobotId> unheard;  ///< expected bidders whose sheet did not arrive in time
};

/// Everything a coordinator may know when it decides. References hold for the call only.
struct Situation {
  double now_s = 0.0;
  RobotId self = 0;
  const RobotSpec& spec;
  Pose2 pose;
  const OccupancyGrid& map;
  const decision::Passability& passable;       ///< for this robot
  Cell at;                                     ///< the cell it is in
  std::span<const Teammate> team;              ///< team-mates heard recently
  std::span<const Teammate> known;             ///< everybody ever heard, as last heard; placed where last heard or seen
  std::optional<Task> task;                    ///< the current one
  bool needs_task = false;                     ///< it is done, void, or there is none, and the map may offer one
  double explored_rate = 0.0;                  ///< A(k) [m^2/s]
  std::span<const link::Delivery> inbox;       ///< auction messages since the last call
  const std::function<std::vector<BidEntry>(const TaskGrain&)>& tasks;  ///< what this robot could do; costs a field
};

struct Decision {
  enum class Verdict {
    kKeep,     ///< go on as before
    kGo,       ///< drive to `task`
    kIdle,     ///< no task for this robot for now
    kNothing,  ///< nothing left that this robot could explore
  };
  Verdict verdict = Verdict::kKeep;
  std::optional<Task> task;
  double value = 0.0;                  ///< of the winning bid, in the rule's own unit
  std::optional<Epoch> epoch;          ///< of the award that is followed from now on; team-mates hear of it
  std::vector<Message> send;
  std::vector<AuctionRecord> records;  ///< rounds that this robot closed
};

/// Decides for one robot. Keeps its own state between calls; sees no clock but Situation::now_s.
class Coordinator {
 public:
  virtual ~Coordinator() = default;
  virtual Decision decide(const Situation& situation) = 0;
};

/// What all robots of a team agree on beforehand.
struct CoordinatorSettings {
  auction::BidParameters bids;
  double beta = 1.0;             ///< Burgard's weight of the distance
  decision::DvfReading dvf;      ///< independent, dvf, dvf-reactive
  double cluster_spacing = 4.0;  ///< block edge of cluster tasks [m]; the team's shortest sensing range by default
};

struct CoordinatorInfo {
  std::string name;
  std::string one_line;
};

/// The table of coordinators, in the order of `outrider list coordinators`.
const std::vector<CoordinatorInfo>& coordinators();
/// Throws InputError with the nearest names when there is none called `name`.
std::unique_ptr<Coordinator> make_coordinator(std::string_view name, const CoordinatorSettings& settings);

}  // namespace outrider::explorer
