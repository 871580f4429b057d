#pragma once
// One robot: scan -> map -> frontiers -> coordinate -> goal -> motion. Runs unchanged in the simulator and live.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <variant>
#include <vector>

#include "decision/local_coordination.hpp"
#include "decision/traffic.hpp"
#include "explorer/coordinator.hpp"
#include "explorer/map_exchange.hpp"
#include "link/bus.hpp"
#include "link/radio.hpp"
#include "world/bit_grid.hpp"
#include "world/body.hpp"
#include "world/team_map.hpp"

namespace outrider::explorer {

/// How scans become changed cells: the map of record of one robot (slam_glue's GridMapper, or a test's own).
class ScanMapper {
 public:
  virtual ~ScanMapper() = default;
  /// Inserts a scan; appends the indices of cells whose three-state value changed.
  virtual void insert(const PosedScan& scan, std::vector<std::uint32_t>& changed) = 0;
  virtual const OccupancyGrid& states() const = 0;
};

/// Makes the scan mapper of a robot that scans.
using MapperFactory = std::function<std::unique_ptr<ScanMapper>(const GridGeometry&, const RobotSpec&)>;

struct ExplorerSettings {
  double status_period = 0.5;    ///< [s] between status messages when nothing changes
  double silent_after = 2.0;     ///< a team-mate not heard for this long does not bid [s]
  bool return_home = false;      ///< drive back to the start when nothing is left
  TaskGrain grain;
  decision::LocalThresholds local;
};

struct GoalEvent {
  RobotId robot;
  Task task;
  double distance_m;
  double value;
};
struct TaskEndEvent {
  RobotId robot;
  Cell task;
  const char* how;  ///< "reached", "seen from afar", "too little left", "no way", "not observable", "blocked",
                    ///< "out of time", "reassigned"
};
struct PhaseEvent {
  RobotId robot;
  const char* phase;  ///< "idle", "done", "returning", "home", "stranded", "making room"
};
struct FaultEvent {
  RobotId robot;
  const char* what;  ///< "kill", "revive", "slow", "deaf", "hears again"
};
struct BreakEvent {
  link::Break which;
  bool begins;  ///< or ends
};
using Event = std::variant<GoalEvent, TaskEndEvent, PhaseEvent, FaultEvent, BreakEvent, AuctionRecord>;
using EventSink = std::function<void(double t, const Event&)>;

/// One robot of the team. Owns its map and its coordinator; body, bus and mapper come from outside.
class Explorer {
 public:
  /// `mapper` may be null when the body senses cells. All references must outlive the explorer.
  Explorer(RobotId self, RobotSpec spec, const GridGeometry& geometry, const ExplorerSettings& settings, Body& body,
           link::Bus& bus, std::unique_ptr<ScanMapper> mapper, std::unique_ptr<Coordinator> coordinator, EventSink sink);

  /// Takes in what the body sensed, updates the map, shares news. `now_s` never decreases.
  void sense(double now_s);
  /// Handles mail. True when there was any.
  bool listen(double now_s);
  /// Decides where to go when that is due, and drives.
  void act(double now_s);

  /// Nothing left, home if asked to return, and everybody in reach knows the same.
  bool done() const { return phase_ == Phase::kDone && settled_ && !(settings_.return_home && making_room_for_); }
  bool exploring() const { return phase_ == Phase::kExploring; }
  bool under_way() const { return task_.has_value(); }
  const OccupancyGrid& map() const { return map_.states(); }
  /// Cells that the own sensor saw for the first time during the last sense().
  const std::vector<std::uint32_t>& observed() const { return observed_; }
  const Pose2& pose() const { return pose_; }
  std::uint64_t map_hash() const { return map_.hash(); }
  /// Everybody ever heard, as last heard, by robot.
  const std::vector<Teammate>& team() const { return team_; }
  std::optional<Task> task() const { return task_; }
  /// Frontiers of `map` (the team's) that are left, as this robot sees them.
  std::vector<Left> left(const OccupancyGrid& map) const { return board_.left(map); }
  double explored_rate() const { return rate_.value(); }
  /// A revived robot forgets where it was going, not what it knows.
  void restart(double now_s);

 private:
  enum class Phase { kExploring, kReturning, kDone };

  void take_in(const Sensing& sensing);
  void note_news(double now_s);
  void share();
  void send_status(double now_s);
  void hear(const link::Delivery& delivery, double now_s);
  /// Said something of late.
  bool in_hearing(const Teammate& mate, double now_s) const { return now_s <= mate.heard_s + settings_.silent_after; }
  std::span<const Teammate> heard_of_late(double now_s);
  void run_coordinator(double now_s);
  void apply(const Decision& decision, double now_s);
  void check_task(double now_s);
  double patience() const;
  void end_task(const char* how, double now_s);
  void nothing_left(double now_s);
  void go_home(double now_s);
  bool plan(Cell stand);
  void drive(std::vector<Cell> way);
  void stop();
  bool way_is_passable() const;
  void trim_way();
  void give_way(double now_s);
  void resolve_block(double now_s);
  void give_back(const char* how, double now_s);
  void coordinate_locally(double now_s);
  decision::LocalAction local_action(const decision::Neighbour& mate) const;
  bool make_room(const decision::Neighbour& asker, std::span<const decision::Neighbour> around, double now_s);
  std::optional<Cell> destination() const;
  bool would_meet(const Teammate& mate);
  bool room_is_needed(double now_s);
  void keep_making_room(double now_s);
  void retreat_from(const decision::Neighbour& silent, std::span<const decision::Neighbour> around, double now_s);
  bool has_moved(const decision::Neighbour& mate);
  void stroll(const decision::Neighbour& mate, std::span<const decision::Neighbour> around, double now_s);
  void strand(double now_s);
  void step_aside(std::span<const decision::Neighbour> around, double now_s);
  std::vector<Cell> straight_on(Point from) const;
  void note_trail();
  std::vector<decision::Neighbour> neighbours(double now_s) const;
  int priority() const;
  Cell here() const { return map_.states().geometry().cell_of(pose_.position()); }
  Cell base() const;
  /// Stands there for good, or as near as a real body gets.
  bool has_reached(Cell stand) const;
  bool safe_straight(Point from, Point to) const;
  bool clear_of_team(Point from, Point to) const;

  RobotId self_;
  RobotSpec spec_;
  ExplorerSettings settings_;
  Body& body_;
  link::Bus& bus_;
  std::unique_ptr<ScanMapper> mapper_;
  std::unique_ptr<Coordinator> coordinator_;
  EventSink sink_;

  TeamMap map_;
  MapExchange exchange_;
  BitGrid seen_;                       // where the own sensor saw the cell
  decision::Passability passable_;
  decision::Traffic traffic_;
  decision::LocalCoordination local_;
  TaskBoard board_;
  auction::ExploredRate rate_;
  std::vector<std::uint32_t> observed_, changed_;

  Phase phase_ = Phase::kExploring;
  Pose2 pose_;
  bool arrived_ = true, blocked_ = false;
  std::vector<Sighting> sightings_;
  std::vector<Teammate> team_;         // sorted by robot, everybody ever heard
  std::vector<Teammate> heard_;        // those heard recently, when these are not all
  std::vector<link::Delivery> inbox_;
  std::uint32_t seq_ = 0;

  std::optional<Task> task_;
  Epoch epoch_;                        // of the award that is followed
  std::vector<Cell> way_;              // from the current cell on, what is left to drive
  double map_news_s_ = 0.0;            // when the map last changed
  double refused_s_ = -1e9;            // when the coordinator last had nothing for us
  double deadline_s_ = 0.0;            // for the task [s]
  double arrived_s_ = 0.0;             // when the stand was reached
  double look_at_s_ = 0.0;             // when to ask next whether the task is still worth its way
  double new_area_ = 0.0;              // Delta A of the auction period so far [m^2]
  double period_begin_s_ = 0.0;
  double status_due_s_ = 0.0;
  bool status_news_ = true;
  bool settled_ = true;

  double blocked_since_s_ = -1.0;      // < 0: not blocked
  double last_try_s_ = -1e9;
  std::map<std::size_t, int> blocked_tries_;  // cell of a task -> how often the way there stayed blocked
  std::optional<RobotId> asks_;        // whom we ask to make room
  std::optional<RobotId> making_room_for_;
  bool room_is_for_silent_ = false;
  std::optional<int> lent_priority_;   // of whom room is made for
  double making_room_until_s_ = 0.0;
  double touched_since_s_ = 0.0;       // by somebody silent, while idle
  int stood_aside_ = 0;                // times since there was something to do
  int retreats_ = 0;                   // from silent robots in the way, for this task
  std::map<RobotId, Point> blocked_at_;  // where somebody was when it was last in the way
  std::minstd_rand luck_;              // breaks ties between robots that block each other
  bool stranded_ = false;              // gave up driving home
  bool held_ = false;                  // stopped on the way, to let somebody pass
  double wait_until_s_ = -1e9;         // nobody is waited for longer than this ...
  double no_wait_until_s_ = -1e9;      // ... and then not again until this
  std::vector<Cell> trail_;            // cells driven through of late, the current one last
};

}  // namespace outrider::explorer
