// Under ideal radio the auction by messages awards what one auction in one place awards, in thousands of situations.

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <random>

#include "explorer/coordinator.hpp"
#include "world/ray.hpp"

namespace outrider::explorer {
namespace {

const GridGeometry kField{1.0, {0.0, 0.0}, 30, 30};

/// One robot in the middle of a mission: what it could do, and its coordinator.
struct Robot {
  RobotSpec spec;
  Pose2 pose;
  std::vector<BidEntry> entries;
  std::optional<Task> task;
  bool needs_task = false;
  double rate = 0.0;
  std::unique_ptr<Coordinator> coordinator;
  std::vector<link::Delivery> inbox;
};

class Team {
 public:
  Team(std::uint64_t seed, const std::string& coordinator, const CoordinatorSettings& settings)
      : random_(seed), map_(kField, CellState::kFree), passable_(kField, 0.3) {
    for (std::size_t k = 0; k < below(60); ++k) map_[below(map_.size())] = CellState::kOccupied;
    std::vector<Cell> tasks;
    for (std::size_t k = 0; k < 1 + below(25); ++k) tasks.push_back(kField.cell_at(below(map_.size())));
    std::sort(tasks.begin(), tasks.end(), [](Cell a, Cell b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
    tasks.erase(std::unique(tasks.begin(), tasks.end()), tasks.end());
    const std::size_t n = 1 + below(6);
    for (std::size_t r = 0; r < n; ++r) robots_.push_back(draw_robot(tasks, coordinator, settings));
    const std::size_t finisher = below(n);
    for (std::size_t r = 0; r < n; ++r) robots_[r].needs_task = r == finisher || !robots_[r].task || below(4) == 0;
  }

  /// Runs the protocol until a round has been closed and nobody has anything to say.
  void play() {
    for (int step = 0; step < 20 && rounds_.empty(); ++step, now_s_ += 0.1) {
      for (std::size_t turn = 0; turn < 20 * robots_.size(); ++turn) decide(turn % robots_.size());
    }
  }

  const std::vector<AuctionRecord>& rounds() const { return rounds_; }
  const std::vector<Robot>& robots() const { return robots_; }
  bool clear(Point a, Point b) const { return line_of_sight(map_, kField.cell_of(a), kField.cell_of(b)); }

  /// Everybody's sheet as it is before any round.
  std::vector<BidSheet> sheets() const {
    std::vector<BidSheet> all;
    for (std::size_t r = 0; r < robots_.size(); ++r) {
      const Robot& robot = robots_[r];
      BidSheet sheet{.robot = static_cast<RobotId>(r),
                     .pose = robot.pose,
                     .speed = robot.spec.speed,
                     .range = robot.spec.range,
                     .explored_rate = robot.rate,
                     .busy = robot.task && !robot.needs_task};
      if (robot.task) sheet.goal = robot.task->cell;
      sheet.entries = robot.entries;
      all.push_back(std::move(sheet));
    }
    return all;
  }

 private:
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_() % n); }

  Robot draw_robot(const std::vector<Cell>& tasks, const std::string& coordinator,
                   const CoordinatorSettings& settings) {
    Robot robot;
    robot.spec.speed = 1.0 + static_cast<double>(below(4));
    robot.spec.range = 2.0 + static_cast<double>(below(6));
    const Point at = kField.center(kField.cell_at(below(map_.size())));
    robot.pose = {at.x, at.y, 0.0};
    robot.rate = static_cast<double>(below(50)) / 10.0;
    for (const Cell task : tasks)
      if (below(8) > 0)
        robot.entries.push_back({task, task, static_cast<float>(below(60)),
                                 static_cast<float>(1.0 + 1.2 * distance(at, kField.center(task)))});
    if (!robot.entries.empty() && below(3) > 0) {
      const BidEntry& entry = robot.entries[below(robot.entries.size())];
      robot.task = Task{entry.task, entry.stand};
    }
    robot.coordinator = make_coordinator(coordinator, settings);
    return robot;
  }

  void decide(std::size_t r) {
    Robot& robot = robots_[r];
    std::vector<Teammate> team;
    for (std::size_t other = 0; other < robots_.size(); ++other) {
      if (other == r) continue;
      StatusMessage status{.robot = static_cast<RobotId>(other), .pose = robots_[other].pose};
      if (robots_[other].task) status.goal = robots_[other].task->cell;
      team.push_back({static_cast<RobotId>(other), status, now_s_});
    }
    const std::vector<link::Delivery> inbox = std::exchange(robot.inbox, {});
    const std::function<std::vector<BidEntry>(const TaskGrain&)> tasks = [&](const TaskGrain&) {
      return robot.entries;
    };
    const Situation situation{now_s_,
                              static_cast<RobotId>(r),
                              robot.spec,
                              robot.pose,
                              map_,
                              passable_,
                              kField.cell_of(robot.pose.position()),
                              team,
                              team,
                              robot.task,
                              robot.needs_task && rounds_.empty(),
                              robot.rate,
                              inbox,
                              tasks};
    Decision decision = robot.coordinator->decide(situation);
    for (const AuctionRecord& round : decision.records) rounds_.push_back(round);
    for (Message& message : decision.send) {
      const auto shared = std::make_shared<const Message>(std::move(message));
      for (std::size_t other = 0; other < robots_.size(); ++other)
        if (other != r) robots_[other].inbox.push_back({static_cast<RobotId>(r), shared});
    }
    if (decision.verdict == Decision::Verdict::kGo) robot.task = decision.task;
    if (decision.verdict == Decision::Verdict::kIdle) robot.task.reset();
  }

  std::mt19937_64 random_;
  OccupancyGrid map_;
  decision::Passability passable_;
  std::vector<Robot> robots_;
  std::vector<AuctionRecord> rounds_;
  double now_s_ = 10.0;
};

TEST(DistributedAuction, AwardsWhatOneAuctionInOnePlaceAwards) {
  const char* rules[] = {"ia", "ea", "daa", "ta"};
  std::size_t compared = 0;
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    const char* rule = rules[seed % 4];
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", " << rule);
    CoordinatorSettings settings;
    if (seed % 3 == 0) settings.bids.turn = auction::Turn::kRobotOrder;
    if (seed % 5 == 0) settings.bids.rebid = auction::Rebid::kFinisher;
    Team team(seed, rule, settings);
    const auto sheets = team.sheets();
    std::vector<std::optional<Task>> before;
    for (const Robot& robot : team.robots()) before.push_back(robot.task);
    team.play();
    if (team.rounds().empty()) {  // whoever needed a task had nothing to sell
      for (const Robot& robot : team.robots()) EXPECT_TRUE(!robot.needs_task || robot.entries.empty());
      continue;
    }
    ASSERT_EQ(team.rounds().size(), 1U);
    const auto expected =
        auction::sequential_auction(auction::BidTable(sheets, kField), *auction::bid_rule(rule), settings.bids,
                                    [&](Point a, Point b) { return team.clear(a, b); });
    ASSERT_EQ(team.rounds()[0].awards.size(), expected.size());
    for (std::size_t r = 0; r < team.robots().size(); ++r) {
      const auto award = std::find_if(expected.begin(), expected.end(),
                                      [&](const Award& a) { return a.robot == static_cast<RobotId>(r); });
      const bool keeps = settings.bids.rebid == auction::Rebid::kFinisher && sheets[r].busy;
      const std::optional<Task> task = keeps                     ? before[r]
                                       : award == expected.end() ? std::nullopt
                                                                 : std::optional(Task{award->task, award->stand});
      EXPECT_EQ(team.robots()[r].task, task) << "robot " << r;
    }
    ++compared;
  }
  EXPECT_GT(compared, 2000U);
}

}  // namespace
}  // namespace outrider::explorer
