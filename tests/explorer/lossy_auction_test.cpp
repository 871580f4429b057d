// The auction's messages over a channel that loses, delays, reorders and doubles: properties over many seeds, and the
// sequential auction as its oracle under the ideal radio.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <random>

#include "explorer/auction_coordinator.hpp"
#include "link/codec.hpp"

namespace outrider::explorer {
namespace {

constexpr double kDt = 0.1;
const GridGeometry kFloor{1.0, {0.0, 0.0}, 40, 40};

TaskGrain every_task(const Situation&) { return {}; }

struct Air {
  double loss = 0.0, repeat = 0.0, most_delay_s = 0.0;
  std::function<bool(RobotId, RobotId)> cut = [](RobotId, RobotId) { return false; };
};

/// Robots on an open floor with tasks that end when somebody stands on them. Stands in for Explorer: it obeys verdicts,
/// drives, and reports.
class Bidders {
 public:
  Bidders(int robots, int tasks, std::uint64_t seed, bool new_tasks = false)
      : map_(kFloor, CellState::kFree), passable_(kFloor, 0.2), random_(seed), new_tasks_(new_tasks) {
    for (int k = 0; k < tasks; ++k) tasks_.push_back(cell());
    for (RobotId r = 0; r < robots; ++r) {
      Bidder b;
      b.spec.speed = 1.0 + 0.5 * static_cast<double>(random_() % 4);
      b.spec.range = 3.0 + static_cast<double>(random_() % 5);
      b.at = {uniform() * 39.0, uniform() * 39.0};
      b.coordinator = make_auction_coordinator(every_task, [](const auction::BidTable& table, const auction::Clear& clear) {
        return auction::sequential_auction(table, auction::bid_ea, {}, clear);
      });
      robots_.push_back(std::move(b));
    }
  }

  void run(double seconds, const Air& air) {
    for (const double end = now_ + seconds; now_ + 1e-9 < end; now_ += kDt) step(air);
  }

  struct Bidder {
    RobotSpec spec;
    Point at;
    std::unique_ptr<Coordinator> coordinator;
    std::optional<Task> task;
    Epoch epoch;
    std::vector<Teammate> known;
    std::vector<link::Delivery> inbox;
    double status_s = 0.0, refused_s = -1e9;
    bool alive = true;
  };
  std::vector<Bidder> robots_;
  std::vector<Cell> tasks_;
  std::vector<AuctionRecord> records;
  std::map<std::pair<int, int>, double> first_sold_to_living;  ///< task (y, x) -> when, once `watch` is set
  bool watch = false;
  double longest_conflict_s = 0.0;  ///< two robots that hear each other with the same task
  std::size_t messages = 0;
  double now_ = 0.0;
  std::function<void(const AuctionRecord&)> on_record = [](const AuctionRecord&) {};

  std::vector<BidEntry> entries(const Bidder& b) const {
    std::vector<BidEntry> list;
    for (const Cell task : tasks_)
      list.push_back({task, task, 10.0F + static_cast<float>((task.x * 7 + task.y * 13) % 20),
                      static_cast<float>(distance(b.at, kFloor.center(task)))});
    return list;
  }

 private:
  struct Copy {
    double at_s;
    RobotId to;
    link::Delivery delivery;
  };

  double uniform() { return static_cast<double>(random_() >> 11U) * 0x1p-53; }
  Cell cell() { return {static_cast<int>(random_() % 40), static_cast<int>(random_() % 40)}; }

  void step(const Air& air) {
    for (Bidder& b : robots_)
      if (b.alive) drive(b);
    for (int round = 0; round < 8 && deliver(air); ++round) {}
    for (RobotId r = 0; r < static_cast<RobotId>(robots_.size()); ++r)
      if (robots_[static_cast<std::size_t>(r)].alive) act(r, air);
    for (int round = 0; round < 8 && deliver(air); ++round) {}
    note_conflicts();
    if (new_tasks_ && random_() % 20 == 0) tasks_.push_back(cell());
  }

  void drive(Bidder& b) {
    if (!b.task) return;
    const Point goal = kFloor.center(b.task->stand);
    const double left = distance(b.at, goal), way = std::min(left, b.spec.speed * kDt);
    if (left > 0.0) b.at = {b.at.x + (goal.x - b.at.x) * way / left, b.at.y + (goal.y - b.at.y) * way / left};
    if (way == left) std::erase(tasks_, b.task->cell);
  }

  void act(RobotId r, const Air& air) {
    Bidder& b = robots_[static_cast<std::size_t>(r)];
    const bool void_task = b.task && std::find(tasks_.begin(), tasks_.end(), b.task->cell) == tasks_.end();
    if (void_task) b.task.reset();
    decide(r, air);
    if (void_task || now_ >= b.status_s) say_status(r, air);
  }

  void decide(RobotId r, const Air& air) {
    Bidder& b = robots_[static_cast<std::size_t>(r)];
    std::vector<Teammate> heard;
    for (const Teammate& mate : b.known)
      if (now_ <= mate.heard_s + 2.0) heard.push_back(mate);
    const std::function<std::vector<BidEntry>(const TaskGrain&)> tasks = [&](const TaskGrain&) { return entries(b); };
    const bool needs = !b.task && now_ >= b.refused_s + 1.0;
    const Situation s{now_, r, b.spec, {b.at.x, b.at.y, 0.0}, map_, passable_, kFloor.cell_of(b.at), heard, b.known,
                      b.task, needs, 0.0, b.inbox, tasks};
    Decision d = b.coordinator->decide(s);
    b.inbox.clear();
    b.epoch = d.epoch.value_or(b.epoch);
    const auto before = b.task;
    if (d.verdict == Decision::Verdict::kGo) b.task = d.task;
    if (d.verdict == Decision::Verdict::kIdle) b.task.reset(), b.refused_s = now_;
    if (d.verdict == Decision::Verdict::kNothing) b.refused_s = now_;
    for (Message& m : d.send) send(r, std::move(m), air);
    for (const AuctionRecord& record : d.records) {
      on_record(record);
      for (const Award& a : record.awards)
        if (watch && robots_[static_cast<std::size_t>(a.robot)].alive) first_sold_to_living.try_emplace({a.task.y, a.task.x}, now_);
      records.push_back(record);
    }
    if (b.task != before) b.status_s = now_;
  }

  void say_status(RobotId r, const Air& air) {
    Bidder& b = robots_[static_cast<std::size_t>(r)];
    StatusMessage status{.robot = r};
    if (b.task) status.goal = b.task->cell;
    status.epoch = b.epoch;
    b.status_s = now_ + 0.5;
    send(r, status, air);
  }

  void send(RobotId from, Message message, const Air& air) {
    ++messages;
    EXPECT_LE(link::encoded_size(message), kMostMessageBytes);
    const auto shared = std::make_shared<const Message>(std::move(message));
    for (RobotId to = 0; to < static_cast<RobotId>(robots_.size()); ++to) {
      if (to == from || air.cut(from, to)) continue;
      for (int copies = 1 + (uniform() < air.repeat); copies > 0; --copies)
        if (uniform() >= air.loss) in_flight_.push_back({now_ + uniform() * air.most_delay_s, to, {from, shared}});
    }
  }

  /// True when anything arrived.
  bool deliver(const Air& air) {
    std::vector<Copy> due, later;
    for (Copy& copy : std::exchange(in_flight_, {})) (copy.at_s <= now_ ? due : later).push_back(std::move(copy));
    in_flight_ = std::move(later);
    std::stable_sort(due.begin(), due.end(), [](const Copy& a, const Copy& b) { return a.at_s < b.at_s; });
    std::vector<char> mail(robots_.size());
    for (Copy& copy : due) {
      Bidder& b = robots_[static_cast<std::size_t>(copy.to)];
      if (const auto* status = std::get_if<StatusMessage>(copy.delivery.message.get())) {
        auto mate = std::find_if(b.known.begin(), b.known.end(), [&](const Teammate& t) { return t.robot == status->robot; });
        if (mate == b.known.end()) mate = b.known.insert(mate, Teammate{status->robot, {}, 0.0});
        *mate = {status->robot, *status, now_};
      } else {
        mail[static_cast<std::size_t>(copy.to)] = 1;
        b.inbox.push_back(std::move(copy.delivery));
      }
    }
    for (std::size_t r = 0; r < robots_.size(); ++r)
      if (mail[r] && robots_[r].alive) decide(static_cast<RobotId>(r), air);
    return !due.empty();
  }

  bool hears(std::size_t a, std::size_t b) const {  // a status within the last second
    return std::any_of(robots_[a].known.begin(), robots_[a].known.end(), [&](const Teammate& t) {
      return t.robot == static_cast<RobotId>(b) && now_ <= t.heard_s + 1.0;
    });
  }

  void note_conflicts() {
    for (std::size_t a = 0; a < robots_.size(); ++a)
      for (std::size_t b = a + 1; b < robots_.size(); ++b) {
        const bool same = robots_[a].alive && robots_[b].alive && robots_[a].task && robots_[a].task == robots_[b].task &&
                          hears(a, b) && hears(b, a);
        double& since = conflicts_.try_emplace({a, b}, now_).first->second;
        if (!same) since = now_;
        longest_conflict_s = std::max(longest_conflict_s, now_ - since);
      }
  }

  OccupancyGrid map_;
  decision::Passability passable_;
  std::mt19937_64 random_;
  bool new_tasks_;
  std::vector<Copy> in_flight_;
  std::map<std::pair<std::size_t, std::size_t>, double> conflicts_;
};

TEST(LossyAuction, WithIdealRadioEveryRoundIsTheSequentialAuctionOfAllTheirBids) {
  std::size_t rounds = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    Bidders team(1 + static_cast<int>(seed % 6), 1 + static_cast<int>(seed * 7 % 90), seed, seed % 2 == 0);
    team.on_record = [&](const AuctionRecord& record) {
      ++rounds;
      std::vector<BidSheet> sheets;  // straight from everybody's mind, no message in between
      for (RobotId r = 0; r < static_cast<RobotId>(team.robots_.size()); ++r) {
        const auto& b = team.robots_[static_cast<std::size_t>(r)];
        sheets.push_back({record.round, r, {b.at.x, b.at.y, 0.0}, b.spec.speed, b.spec.range, 0.0, false, {}, team.entries(b)});
      }
      if (team.now_ < 0.05) return;  // nobody has been heard of yet
      const auto expected = auction::sequential_auction(auction::BidTable(sheets, kFloor), auction::bid_ea, {},
                                                        [](Point, Point) { return true; });
      EXPECT_TRUE(record.unheard.empty());
      ASSERT_EQ(record.awards.size(), expected.size());
      for (std::size_t k = 0; k < expected.size(); ++k) {
        EXPECT_EQ(record.awards[k].robot, expected[k].robot);
        EXPECT_EQ(record.awards[k].task, expected[k].task);
        EXPECT_EQ(record.awards[k].value, expected[k].value);
      }
    };
    const Air ideal;
    team.run(0.2, ideal);
    for (int k = 0; k < 150; ++k) {
      const std::size_t before = team.records.size();
      team.run(kDt, ideal);
      if (team.records.size() == before) continue;
      for (const Award& award : team.records.back().awards) {  // and everybody does what was decided
        const auto& b = team.robots_[static_cast<std::size_t>(award.robot)];
        EXPECT_TRUE(!b.task || b.task->cell == award.task);
      }
    }
    EXPECT_EQ(team.longest_conflict_s, 0.0);
  }
  EXPECT_GT(rounds, 1000U);
}

TEST(LossyAuction, NobodyKeepsATeamMatesTaskForLongerThanALeaseAndAllTasksAreServed) {
  double longest = 0.0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE(seed);
    Bidders team(2 + static_cast<int>(seed % 4), 3 + static_cast<int>(seed % 6), seed);
    const Air bad{.loss = 0.1 * static_cast<double>(seed % 6), .repeat = 0.2, .most_delay_s = 0.1 * static_cast<double>(seed % 4)};
    while (!team.tasks_.empty() && team.now_ < 300.0) team.run(5.0, bad);
    EXPECT_LE(team.longest_conflict_s, kLease);
    EXPECT_TRUE(team.tasks_.empty()) << team.tasks_.size() << " left";
    longest = std::max(longest, team.longest_conflict_s);
  }
  RecordProperty("longest_conflict_ms", static_cast<int>(longest * 1000.0));
}

TEST(LossyAuction, AfterAPartitionNoTaskIsSharedForLongerThanALease) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    Bidders team(4, 14, seed, true);
    team.run(2.0, {});
    team.run(10.0, {.cut = [](RobotId a, RobotId b) { return a / 2 != b / 2; }});
    team.run(10.0, {.loss = 0.3, .repeat = 0.2, .most_delay_s = 0.2});
    EXPECT_LE(team.longest_conflict_s, kLease);
  }
}

TEST(LossyAuction, TheTaskOfADeadRobotIsSoldAgainWhenItsLeaseHasEnded) {
  std::vector<double> delays;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE(seed);
    Bidders team(4, 3, seed);  // one robot has nothing to do
    const Air air{.loss = seed % 2 ? 0.3 : 0.0, .repeat = 0.1, .most_delay_s = 0.1};
    team.run(2.0, air);
    auto& victim = team.robots_[seed % 4];
    if (!victim.task) continue;
    const Cell task = victim.task->cell;
    victim.alive = false;
    const double died_s = team.now_;
    team.watch = true;
    team.run(8.0, air);
    const auto sold = team.first_sold_to_living.find({task.y, task.x});
    const bool served = std::find(team.tasks_.begin(), team.tasks_.end(), task) == team.tasks_.end();
    EXPECT_TRUE(sold != team.first_sold_to_living.end() || served);
    if (sold != team.first_sold_to_living.end()) delays.push_back(sold->second - died_s);
  }
  ASSERT_GT(delays.size(), 100U);
  std::sort(delays.begin(), delays.end());
  RecordProperty("median_ms", static_cast<int>(1000.0 * delays[delays.size() / 2]));
  RecordProperty("p95_ms", static_cast<int>(1000.0 * delays[delays.size() * 95 / 100]));
}

TEST(LossyAuction, ARobotThatStartsAgainWithoutMemoryIsObeyedAgain) {
  Bidders team(3, 20, 5, true);
  team.run(10.0, {});
  auto& reborn = team.robots_[0];
  reborn.coordinator = make_auction_coordinator(every_task, [](const auction::BidTable& table, const auction::Clear& clear) {
    return auction::sequential_auction(table, auction::bid_ea, {}, clear);
  });
  reborn.task.reset();
  reborn.epoch = {};
  reborn.known.clear();
  const std::size_t before = team.records.size();
  team.run(10.0, {});
  ASSERT_GT(team.records.size(), before + 1);
  EXPECT_TRUE(reborn.task || team.tasks_.size() < 3);
  EXPECT_GT(reborn.epoch.count, 1U);
  EXPECT_EQ(team.longest_conflict_s, 0.0);
}

TEST(LossyAuction, UnderTheIdealRadioNothingIsSaidTwice) {
  Bidders team(4, 200, 3);
  team.run(5.0, {});
  // A round: one call, four or more parts of sheets from each bidder, one message of awards; statuses besides.
  const std::size_t statuses = 4 * 11, changes = 8 * team.records.size();
  EXPECT_LE(team.messages, statuses + changes + team.records.size() * (1 + 3 * 4 + 1));
}

TEST(LossyAuction, InALargeTeamARoundAsksTheNeighboursOnlyAndEverythingIsServedAllTheSame) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    SCOPED_TRACE(seed);
    Bidders team(40, 80, seed);
    std::size_t most = 0;
    team.on_record = [&](const AuctionRecord& record) { most = std::max(most, record.sheets.size()); };
    while (!team.tasks_.empty() && team.now_ < 120.0) team.run(1.0, {});
    EXPECT_EQ(most, kMostAsked + 1);
    EXPECT_TRUE(team.tasks_.empty()) << team.tasks_.size() << " left";
    EXPECT_LE(team.longest_conflict_s, kLease);
  }
}

}  // namespace
}  // namespace outrider::explorer
