#include "auction/allocation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <random>

#include "auction/assignment.hpp"

namespace outrider::auction {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
const GridGeometry kField{1.0, {0.0, 0.0}, 60, 60};

bool always_clear(Point, Point) { return true; }

/// n robots at random places that bid on m random cells; some robots leave some tasks out.
std::vector<BidSheet> random_sheets(std::mt19937_64& random, int n, int m) {
  std::uniform_int_distribution<int> cell(0, 59), coin(0, 9);
  std::uniform_real_distribution<float> gain(0.0F, 50.0F), stretch(1.0F, 1.5F);
  std::vector<Cell> tasks;
  for (int p = 0; p < m; ++p) {
    const Cell task{cell(random), cell(random)};
    if (std::find(tasks.begin(), tasks.end(), task) == tasks.end()) tasks.push_back(task);
  }
  std::vector<BidSheet> sheets;
  for (int i = 0; i < n; ++i) {
    BidSheet sheet;
    sheet.robot = i;
    sheet.pose = {cell(random) + 0.5, cell(random) + 0.5, 0.0};
    sheet.speed = 1.0 + i % 3;
    sheet.range = 3.0 + i % 4;
    sheet.explored_rate = 0.5 * i;
    for (const Cell task : tasks) {
      if (coin(random) == 0) continue;
      const double d = distance(kField.center(task), sheet.pose.position());
      sheet.entries.push_back({task, task, gain(random), static_cast<float>(d) * stretch(random)});
    }
    sheets.push_back(std::move(sheet));
  }
  return sheets;
}

/// The auction as the paper words it: every bid of eq. 1 to 4 anew at every stage, nothing cached.
std::vector<Award> plain_auction(const std::vector<BidSheet>& sheets, BidRule rule, const BidParameters& k) {
  std::vector<Award> awards;
  const auto target_of = [&](RobotId robot) -> const Award* {
    for (const Award& a : awards)
      if (a.robot == robot) return &a;
    return nullptr;
  };
  for (std::size_t stage = 0; stage < sheets.size(); ++stage) {
    std::optional<Award> best;
    for (const BidSheet& sheet : sheets) {
      if (target_of(sheet.robot)) continue;
      if (k.turn == Turn::kRobotOrder && sheet.robot != static_cast<RobotId>(stage)) continue;
      std::vector<BidEntry> entries = sheet.entries;
      std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
        return a.task.y != b.task.y ? a.task.y < b.task.y : a.task.x < b.task.x;
      });
      for (const BidEntry& entry : entries) {
        if (std::any_of(awards.begin(), awards.end(), [&](const Award& a) { return a.task == entry.task; })) continue;
        const double straight = distance(kField.center(entry.task), sheet.pose.position());
        const double d_p = k.way == Way::kStraight ? straight : static_cast<double>(entry.distance);
        double u_p2 = 0.0;
        for (const BidSheet& other : sheets) {
          if (other.robot == sheet.robot) continue;
          const Award* target = target_of(other.robot);
          const Point at = target ? kField.center(target->task) : other.pose.position();
          const double d = distance(kField.center(entry.task), at);
          u_p2 -= (target ? 1.0 : k.gamma) * std::exp(-d * d / (other.range * other.range));
        }
        const double e = rule({entry.gain, u_p2, d_p, sheet.speed, sheet.explored_rate}, k);
        if (!best || e > best->value + 1e-12) best = Award{sheet.robot, entry.task, entry.stand, e};
      }
    }
    if (best) awards.push_back(*best);
  }
  return awards;
}

TEST(SequentialAuction, EqualsThePaperWordByWord) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    for (const char* name : {"ia", "ea", "daa", "ta"}) {
      SCOPED_TRACE(testing::Message() << name << ", seed " << seed);
      std::mt19937_64 random(seed);
      const auto sheets = random_sheets(random, 2 + static_cast<int>(seed % 5), 25);
      BidParameters k{.rho = 0.7, .gamma = 1.5, .weight = 5.0, .alpha = 0.3};
      if (seed % 3 == 0) k.turn = Turn::kRobotOrder;
      if (seed % 4 == 0) k.way = Way::kStraight;
      if (seed % 5 == 0) k.ta = TaUtility::kUnseen;
      const auto fast = sequential_auction(BidTable(sheets, kField), *bid_rule(name), k, always_clear);
      const auto plain = plain_auction(sheets, *bid_rule(name), k);
      ASSERT_EQ(fast.size(), plain.size());
      for (std::size_t a = 0; a < fast.size(); ++a) {
        EXPECT_EQ(fast[a].robot, plain[a].robot);
        EXPECT_EQ(fast[a].task, plain[a].task);
        EXPECT_NEAR(fast[a].value, plain[a].value, 1e-9 * (1.0 + std::abs(plain[a].value)));
      }
    }
  }
}

TEST(SequentialAuction, BlockedTeamMatesHaveNoInfluence) {
  BidSheet a{.robot = 0, .pose = {1.5, 0.5, 0.0}, .speed = 1.0, .range = 4.0};
  BidSheet b{.robot = 1, .pose = {2.5, 0.5, 0.0}, .speed = 1.0, .range = 4.0};
  a.entries = {{{5, 0}, {5, 0}, 10.0F, 4.0F}};
  const std::vector<BidSheet> sheets{a, b};
  const BidParameters k{.rho = 1.0, .gamma = 1.0, .weight = 1.0};
  const auto value = [&](const Clear& clear) {
    return sequential_auction(BidTable(sheets, kField), bid_ia, k, clear).at(0).value;
  };
  EXPECT_DOUBLE_EQ(value([](Point, Point) { return false; }), 10.0 - 4.0);
  EXPECT_NEAR(value(always_clear), 10.0 - std::exp(-9.0 / 16.0) - 4.0, 1e-12);
}

TEST(SequentialAuction, RobotsUnderWayKeepTheirTasksWhenOnlyTheFinisherBids) {
  BidSheet busy{.robot = 0, .pose = {1.5, 0.5, 0.0}, .speed = 1.0, .range = 4.0, .busy = true, .goal = Cell{5, 0}};
  BidSheet free{.robot = 1, .pose = {2.5, 0.5, 0.0}, .speed = 1.0, .range = 4.0};
  busy.entries = free.entries = {{{5, 0}, {5, 0}, 10.0F, 3.0F}, {{5, 1}, {5, 1}, 10.0F, 4.0F}};
  const std::vector<BidSheet> sheets{busy, free};
  const BidParameters k{.rho = 1.0, .weight = 1.0, .rebid = Rebid::kFinisher};
  const auto awards = sequential_auction(BidTable(sheets, kField), bid_ia, k, always_clear);
  ASSERT_EQ(awards.size(), 1U);
  EXPECT_EQ(awards[0].robot, 1);
  EXPECT_EQ(awards[0].task, (Cell{5, 1}));
  EXPECT_NEAR(awards[0].value, 10.0 - std::exp(-1.0 / 16.0) - 4.0, 1e-12);
}

/// All tasks, one after the other, to whoever is there first: nothing cached.
TEST(AllTasksAuction, EqualsPlainGreed) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const auto sheets = random_sheets(random, 1 + static_cast<int>(seed % 5), 30);
    const BidTable table(sheets, kField);
    std::vector<double> free_s(sheets.size(), 0.0);
    std::vector<int> last(sheets.size(), -1);
    std::vector<char> sold(table.tasks(), 0);
    const auto awards = all_tasks_auction(table);
    for (std::size_t stage = 0;; ++stage) {
      double best = kInf;
      std::size_t robot = 0, task = 0;
      for (std::size_t i = 0; i < sheets.size(); ++i)
        for (std::size_t p = 0; p < table.tasks(); ++p) {
          if (sold[p] || table.entry(i, p) == nullptr) continue;
          const double d = last[i] < 0
                               ? static_cast<double>(table.entry(i, p)->distance)
                               : distance(table.task_point(static_cast<std::size_t>(last[i])), table.task_point(p));
          const double at = free_s[i] + d / table.sheet(i).speed;
          if (at < best) best = at, robot = i, task = p;
        }
      if (best == kInf) {
        EXPECT_EQ(awards.size(), stage);
        break;
      }
      ASSERT_LT(stage, awards.size());
      EXPECT_NEAR(awards[stage].value, -best, 1e-6);
      free_s[robot] = best;
      last[robot] = static_cast<int>(task);
      sold[task] = 1;
    }
  }
}

TEST(RoundTime, IsNeverBelowTheOptimalAssignmentAndReachesIt) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const auto sheets = random_sheets(random, 1 + static_cast<int>(seed % 7), 20);
    const BidTable table(sheets, kField);
    const RoundTime auction = round_time(table, sequential_auction(table, bid_ea, {}, always_clear));
    EXPECT_LE(auction.least_s, auction.awarded_s + 1e-9);
    const RoundTime optimal = round_time(table, hungarian_assignment(table));
    EXPECT_NEAR(optimal.least_s, optimal.awarded_s, 1e-9);
  }
}

// Laws that every allocation keeps: one task a robot, one robot a task, only bids that were made, all tables.
TEST(Allocations, GiveOneTaskARobotAndOneRobotATask) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    std::mt19937_64 random(seed);
    const auto sheets = random_sheets(random, 1 + static_cast<int>(seed % 7), static_cast<int>(seed % 11));
    const BidTable table(sheets, kField);
    const std::vector<std::vector<Award>> outcomes{
        sequential_auction(table, bid_daa, {}, always_clear),
        sequential_auction(table, bid_daa, {.turn = Turn::kRobotOrder}, always_clear),
        burgard_assignment(table, 1.0, always_clear), hungarian_assignment(table),
        first_of_each(all_tasks_auction(table))};
    for (std::size_t k = 0; k < outcomes.size(); ++k) {
      SCOPED_TRACE(testing::Message() << "allocation " << k << ", seed " << seed);
      const auto& awards = outcomes[k];
      for (std::size_t a = 0; a < awards.size(); ++a) {
        const auto& entries = sheets[static_cast<std::size_t>(awards[a].robot)].entries;
        EXPECT_TRUE(
            std::any_of(entries.begin(), entries.end(), [&](const auto& e) { return e.task == awards[a].task; }));
        for (std::size_t b = a + 1; b < awards.size(); ++b) {
          EXPECT_NE(awards[a].robot, awards[b].robot);
          EXPECT_NE(awards[a].task, awards[b].task);
        }
      }
    }
  }
}

TEST(SequentialAuction, RobotOrderServesTheFirstRobotFirst) {
  BidSheet slow{.robot = 0, .speed = 1.0, .range = 4.0}, near{.robot = 1, .speed = 1.0, .range = 4.0};
  slow.entries = {{{9, 9}, {9, 9}, 10.0F, 8.0F}};
  near.entries = {{{9, 9}, {9, 9}, 10.0F, 1.0F}};
  const std::vector<BidSheet> sheets{near, slow};  // order of arrival does not matter
  const BidTable table(sheets, kField);
  EXPECT_EQ(sequential_auction(table, bid_ta, {.turn = Turn::kRobotOrder}, always_clear).at(0).robot, 0);
  EXPECT_EQ(sequential_auction(table, bid_ta, {}, always_clear).at(0).robot, 1);
}

/// Least cost by trying everything: as many rows as possible, then the cheapest.
std::pair<std::size_t, double> brute_force(const std::vector<double>& cost, std::size_t rows, std::size_t columns) {
  std::pair<std::size_t, double> best{0, 0.0};
  std::vector<char> used(columns, 0);
  const std::function<void(std::size_t, std::size_t, double)> go = [&](std::size_t row, std::size_t served,
                                                                       double sum) {
    if (row == rows) {
      if (served > best.first || (served == best.first && sum < best.second)) best = {served, sum};
      return;
    }
    go(row + 1, served, sum);
    for (std::size_t j = 0; j < columns; ++j)
      if (!used[j] && cost[row * columns + j] != kInf) {
        used[j] = 1;
        go(row + 1, served + 1, sum + cost[row * columns + j]);
        used[j] = 0;
      }
  };
  go(0, 0, 0.0);
  return best;
}

TEST(LeastCostAssignment, EqualsBruteForce) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const std::size_t rows = 1 + seed % 5, columns = 1 + (seed / 5) % 6;
    std::uniform_real_distribution<double> draw(0.0, 10.0);
    std::vector<double> cost(rows * columns);
    for (double& c : cost) c = draw(random) < 2.0 ? kInf : draw(random);
    const auto result = least_cost_assignment(cost, rows, columns);
    std::size_t served = 0;
    double sum = 0.0;
    for (std::size_t i = 0; i < rows; ++i)
      if (result[i] >= 0) {
        ++served;
        sum += cost[i * columns + static_cast<std::size_t>(result[i])];
      }
    const auto [most, least] = brute_force(cost, rows, columns);
    EXPECT_EQ(served, most);
    EXPECT_NEAR(sum, least, 1e-9);
  }
}

TEST(LeastCostAssignment, EmptyTablesServeNobody) {
  EXPECT_TRUE(least_cost_assignment({}, 0, 3).empty());
  EXPECT_EQ(least_cost_assignment({}, 2, 0), (std::vector<int>{-1, -1}));
}

}  // namespace
}  // namespace outrider::auction
