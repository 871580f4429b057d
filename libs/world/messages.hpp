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
  static constexpr std::size_t kMaxWay = 64;
};

/// One cell of the sender's team map. A higher version replaces a lower one; at equal versions the greater state
/// wins (occupied > free > unknown), so merging is commutative, associative and idempotent.
struct CellChange {
  std::uint32_t index = 0;
  CellState state = CellState::kUnknown;
  std::uint8_t version = 0;
};

struct MapUpdate {
  RobotId robot = 0;
  std::uint32_t seq = 0;
  std::vector<CellChange> cells;
};

/// Identifies an auction round: the robot that opened it and its counter.
struct RoundId {
  RobotId opener = 0;
  std::uint32_t count = 0;
  friend bool operator==(const RoundId&, const RoundId&) = default;
};

/// "I finished my task": every robot that hears it answers with its bids.
struct RoundOpen {
  RoundId round;
};

/// What task p would be worth to robot i and what it costs, before the influence of team-mates.
struct BidEntry {
  Cell task;              ///< c_p
  Cell stand;             ///< where the robot would drive to serve it; the task itself when it can stand there
  float gain = 0.0F;      ///< U_p1: unknown cells within sensing range and in line of sight [cells]
  float distance = 0.0F;  ///< D_p: length of the shortest safe path [m]
};

/// All bids of one robot in one round.
struct BidSheet {
  RoundId round;
  RobotId robot = 0;
  Pose2 pose;
  double speed = 0.0;          ///< v [m/s]
  double range = 0.0;          ///< r [m]
  double explored_rate = 0.0;  ///< A(k) [cells/s]
  bool busy = false;           ///< is on its way to `goal`
  std::optional<Cell> goal;
  std::vector<BidEntry> entries;
};

struct Award {
  RobotId robot = 0;
  Cell task;
  Cell stand;
  double value = 0.0;  ///< E of the winning bid
};

/// The outcome of a round. A bidder without an award has no task.
struct Awards {
  RoundId round;
  std::vector<RobotId> bidders;
  std::vector<Award> awards;
};

using Message = std::variant<StatusMessage, MapUpdate, RoundOpen, BidSheet, Awards>;

}  // namespace outrider
