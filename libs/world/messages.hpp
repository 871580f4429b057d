#pragma once
// What robots tell each other, as plain structs. The link room turns them into wire types and back.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "world/grid.hpp"
#include "world/robot.hpp"

namespace outrider {

/// Orders awards: the greater count, then the lower seller, is the newer. Count 0: no award yet.
struct Epoch {
  std::uint32_t count = 0;
  RobotId seller = 0;
  bool newer_than(const Epoch& other) const {
    return count != other.count ? count > other.count : count > 0 && seller < other.seller;
  }
  friend bool operator==(const Epoch&, const Epoch&) = default;
};

/// Who is where and what it is up to. Sent at a steady rate and on every change of goal.
struct StatusMessage {
  RobotId robot = 0;
  std::uint32_t seq = 0;         ///< grows by one a message
  Pose2 pose;                    ///< T_map_robot
  std::optional<Cell> goal;      ///< where it is heading
  std::vector<Cell> way;         ///< next way-points, for local traffic; at most kMaxWay
  double speed = 0.0;            ///< [m/s]
  double range = 0.0;            ///< sensing range [m]
  double radius = 0.0;           ///< [m]
  double explored_rate = 0.0;    ///< A^i(k), Dai 2014 eq. 8 [cells/s]
  bool done = false;             ///< knows of nothing left to explore
  int priority = 0;              ///< in narrow places: the lower goes first (inherited by who makes room for it)
  std::optional<RobotId> asks;   ///< the team-mate that is asked to make room
  std::uint64_t map_hash = 0;    ///< TeamMap::hash()
  Epoch epoch;                   ///< of the award that it follows
  std::vector<RobotId> heard;    ///< team-mates heard lately; at most kMostHeard
  static constexpr std::size_t kMaxWay = 64, kMostHeard = 64;
};

/// A frame on the air carries at most this much, messages are made to fit [bytes].
inline constexpr std::size_t kMostMessageBytes = 1200;

/// Cells of the sender's team map that follow each other in a row and are known alike. `value` is version * 4 + state;
/// the greater value wins (a higher version; at equal versions occupied > free > unknown).
struct CellRun {
  std::uint32_t index = 0;   ///< of the first cell
  std::uint8_t length = 0;   ///< [cells]
  std::uint8_t value = 0;
};

/// News from the sender's own sensor.
struct MapUpdate {
  RobotId robot = 0;
  std::uint32_t seq = 0;
  std::vector<CellRun> runs;  ///< at most kMostRuns
  static constexpr std::size_t kMostRuns = 180;
};

/// A tile of the map in short. The weight is the sum of all values and grows with everything learnt: of two different
/// tiles the heavier one knows something that the other does not, and so do both when they weigh the same.
struct TileMark {
  std::uint32_t weight = 0;
  std::uint32_t hash = 0;
  friend bool operator==(const TileMark&, const TileMark&) = default;
};

/// What the sender knows, a stretch of tiles; those not named in any stretch it knows nothing of.
struct MapDigest {
  RobotId robot = 0;
  std::uint32_t first = 0;      ///< number of the first tile
  std::vector<TileMark> marks;  ///< at most kMostMarks
  static constexpr std::size_t kMostMarks = 128;
};

/// "Send me these tiles."
struct TileRequest {
  RobotId robot = 0;
  RobotId to = 0;
  std::vector<std::uint32_t> tiles;  ///< at most kMostTiles
  static constexpr std::size_t kMostTiles = 256;
};

/// All that the sender knows of a tile.
struct MapTile {
  RobotId robot = 0;
  std::uint32_t tile = 0;
  std::vector<std::uint8_t> cells;  ///< values, row by row; at most kMostCells
  static constexpr std::size_t kMostCells = 1024;
};

/// Identifies an auction round: the robot that opened it and its counter.
struct RoundId {
  RobotId opener = 0;
  std::uint32_t count = 0;
  friend bool operator==(const RoundId&, const RoundId&) = default;
};

/// "I finished my task": every robot that is asked answers with its bids. Repeated while the round is open.
struct RoundOpen {
  RoundId round;
  std::vector<RobotId> heard;  ///< whose sheets are in; at most kMostHeard
  std::vector<RobotId> asked;  ///< of a large team the nearest; nobody named: all who hear it. At most kMostAsked
  static constexpr std::size_t kMostHeard = 500, kMostAsked = 32;
};

/// What task p would be worth to robot i and what it costs, before the influence of team-mates.
struct BidEntry {
  Cell task;              ///< c_p
  Cell stand;             ///< where the robot would drive to serve it; the task itself when it can stand there
  float gain = 0.0F;      ///< U_p1: unknown cells within sensing range and in line of sight [cells]
  float distance = 0.0F;  ///< D_p: length of the shortest safe path [m]
};

/// All bids of one robot in one round. On the air a long sheet comes in parts that differ in their entries.
struct BidSheet {
  RoundId round;
  RobotId robot = 0;
  Pose2 pose;
  double speed = 0.0;          ///< v [m/s]
  double range = 0.0;          ///< r [m]
  double explored_rate = 0.0;  ///< A(k) [cells/s]
  bool busy = false;           ///< is on its way to `goal`
  std::optional<Cell> goal;
  std::vector<BidEntry> entries;    ///< at most kMostEntries a part
  std::uint32_t epoch = 0;          ///< count of the newest award that the bidder has heard of
  int part = 0, parts = 1;
  static constexpr std::size_t kMostEntries = 60;
  static constexpr int kMostParts = 64;
};

struct Award {
  RobotId robot = 0;
  Cell task;
  Cell stand;
  double value = 0.0;  ///< E of the winning bid
};

/// The outcome of a round: state, repeated until every bidder follows it or something newer. A bidder without an award
/// has no task. Of a large team each message names some of the bidders and all that these won.
struct Awards {
  RoundId round;
  std::uint32_t epoch = 0;
  std::vector<RobotId> bidders;  ///< at most kMostBidders
  std::vector<Award> awards;     ///< at most one a bidder
  static constexpr std::size_t kMostBidders = 40;
};

/// Who the sender is and in which grid it thinks; for late listeners and logs.
struct Introduction {
  RobotId robot = 0;
  RobotSpec spec;
  GridGeometry geometry;
  std::string coordinator;
  int team = 1;  ///< number of robots
  double time_scale = 1.0;  ///< seconds of its clock in a second of the wall clock; 1 but in simulation
  static constexpr std::size_t kMostName = 64;  ///< bytes of a name
};

/// Who owns a task, as far as the sender knows. Of two claims the one of the higher epoch holds; at equal epochs that
/// of the lower robot, and none loses to any.
struct Claim {
  static constexpr RobotId kNobody = -1;
  std::uint32_t epoch = 0;  ///< grows with every change of hands
  RobotId owner = kNobody;
  friend bool operator==(const Claim&, const Claim&) = default;
};

/// D-SSA (Lozenguez 2015, section 5.3): all that a robot knows of a stretch of tasks, and what they would cost it.
/// Repeated until the auction is over, so any one of them may be lost.
struct ClaimSheet {
  RoundId round;
  RobotId robot = 0;
  std::uint32_t seq = 0;       ///< grows by one a sheet
  std::uint32_t first = 0;     ///< number of the first task
  std::vector<Claim> claims;   ///< at most kMostClaims
  std::vector<double> prices;  ///< r_g - u_i(G_i, g) of each (eq. 9); infinity: cannot do it
  std::uint64_t hash = 0;      ///< of all the sender's claims
  bool content = false;        ///< everybody told it the same claims, and it knows nothing better
  bool done = false;           ///< everybody told it that they are content
  static constexpr std::size_t kMostClaims = 64;
};

/// "Take this task of mine." Its owner changes nothing else until the answer is there.
struct TaskOffer {
  RoundId round;
  RobotId robot = 0;
  RobotId to = 0;
  std::uint32_t serial = 0;  ///< of the sender's offers, grows
  std::uint32_t task = 0;
  std::uint32_t epoch = 0;   ///< of the sender's claim
  double price = 0.0;        ///< what the sender saves
};

struct TaskAnswer {
  enum class Verdict : std::uint8_t {
    kAccepted,  ///< the task is mine now
    kDeclined,  ///< it would cost me more than it saves you
    kBusy,      ///< I am waiting for an answer myself
  };
  RoundId round;
  RobotId robot = 0;
  RobotId to = 0;
  std::uint32_t serial = 0;  ///< of the offer
  Verdict verdict = Verdict::kBusy;
};

/// The best whole allocation that the sender knows of. Repeated until all know the same.
struct PlanSheet {
  RoundId round;
  RobotId robot = 0;
  std::uint32_t seq = 0;
  double makespan = 0.0;         ///< of the longest mission in it
  double total = 0.0;            ///< of all missions
  std::vector<RobotId> owners;   ///< of each task; Claim::kNobody: nobody can do it. At most TaskSet::kMost
  std::uint64_t without = 0;     ///< robots (as bits) that the sender takes for dead
  bool searched = false;         ///< the sender has nothing left to try
};

using Message = std::variant<StatusMessage, MapUpdate, MapDigest, TileRequest, MapTile, RoundOpen, BidSheet, Awards,
                             Introduction, ClaimSheet, TaskOffer, TaskAnswer, PlanSheet>;

/// Messages that serve to share out tasks: a coordinator's affair.
inline bool is_auction_traffic(const Message& message) {
  return std::holds_alternative<RoundOpen>(message) || std::holds_alternative<BidSheet>(message) ||
         std::holds_alternative<Awards>(message) || std::holds_alternative<ClaimSheet>(message) ||
         std::holds_alternative<TaskOffer>(message) || std::holds_alternative<TaskAnswer>(message) ||
         std::holds_alternative<PlanSheet>(message);
}

}  // namespace outrider
