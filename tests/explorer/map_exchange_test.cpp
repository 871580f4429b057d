// Maps catch up after loss, reordering, repetition and partitions; every byte counted.

#include "explorer/map_exchange.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <random>

#include "link/codec.hpp"

namespace outrider::explorer {
namespace {

constexpr double kDt = 0.1;
const GridGeometry kOffice{0.25, {0.0, 0.0}, 160, 120};  // 40 m x 30 m, 20 tiles

struct Air {
  double loss = 0.0, repeat = 0.0, most_delay_s = 0.0;
  std::function<bool(RobotId, RobotId)> cut = [](RobotId, RobotId) { return false; };
};

/// A team of maps that observe at random, speak every 0.1 s and announce their hash every 0.5 s.
class Team {
 public:
  Team(int robots, std::uint64_t seed) : random_(seed) {
    for (RobotId r = 0; r < robots; ++r) {
      robots_.push_back(std::make_unique<Robot>());
      robots_.back()->exchange = std::make_unique<MapExchange>(r, robots_.back()->map, MapExchange::Settings{});
      robots_.back()->phase = random_() % 5;
    }
  }

  void run(double seconds, const Air& air, bool observing) {
    for (const double end = now_ + seconds; now_ + 1e-9 < end; now_ += kDt, ++step_) {
      deliver();
      for (RobotId r = 0; r < size(); ++r) speak(r, air, observing);
    }
    deliver();
  }

  int size() const { return static_cast<int>(robots_.size()); }
  bool equal() const {
    return std::all_of(robots_.begin(), robots_.end(), [&](const auto& r) {
      return r->map.hash() == robots_[0]->map.hash() && r->map.states() == robots_[0]->map.states();
    });
  }
  bool settled() const {
    return std::all_of(robots_.begin(), robots_.end(), [&](const auto& r) { return r->exchange->settled(now_); });
  }
  std::size_t known(RobotId r) const {
    const auto& cells = robots_[static_cast<std::size_t>(r)]->map.states().data();
    return cells.size() - static_cast<std::size_t>(std::count(cells.begin(), cells.end(), CellState::kUnknown));
  }
  std::size_t bytes = 0, messages = 0, largest = 0, repairs = 0;

 private:
  struct Robot {
    TeamMap map{kOffice};
    std::unique_ptr<MapExchange> exchange;
    std::uint64_t phase = 0;
  };
  struct Copy {
    double at_s;
    RobotId to;
    std::shared_ptr<const Message> message;
  };

  double uniform() { return static_cast<double>(random_() >> 11U) * 0x1p-53; }

  void observe(TeamMap& map) {  // a patch of floor with a wall, somewhere
    const Cell at{static_cast<int>(random_() % 150), static_cast<int>(random_() % 112)};
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 10; ++x)
        map.observe(static_cast<std::uint32_t>(kOffice.index({at.x + x, at.y + y})),
                    random_() % 8 ? CellState::kFree : CellState::kOccupied);
  }

  void speak(RobotId r, const Air& air, bool observing) {
    Robot& robot = *robots_[static_cast<std::size_t>(r)];
    if (observing && random_() % 3 == 0) observe(robot.map);
    if (auto runs = robot.map.take_to_share(); !runs.empty()) send(r, MapUpdate{r, 0, std::move(runs)}, air);
    if (step_ % 5 == robot.phase) {
      StatusMessage status;
      status.robot = r;
      status.map_hash = robot.map.hash();
      send(r, status, air);
    }
    for (Message& message : robot.exchange->speak(now_)) {
      ++repairs;
      send(r, std::move(message), air);
    }
  }

  void send(RobotId from, Message message, const Air& air) {
    const std::size_t size = link::encoded_size(message);
    ++messages;
    bytes += size;
    largest = std::max(largest, size);
    const auto shared = std::make_shared<const Message>(std::move(message));
    for (RobotId to = 0; to < this->size(); ++to) {
      if (to == from || air.cut(from, to)) continue;
      const int copies = 1 + (uniform() < air.repeat);
      for (int k = 0; k < copies; ++k)
        if (uniform() >= air.loss) in_flight_.push_back({now_ + uniform() * air.most_delay_s, to, shared});
    }
  }

  void deliver() {
    std::stable_sort(in_flight_.begin(), in_flight_.end(), [](const Copy& a, const Copy& b) { return a.at_s < b.at_s; });
    std::vector<Copy> later;
    for (const Copy& copy : std::exchange(in_flight_, {})) {
      if (copy.at_s > now_) {
        later.push_back(copy);
        continue;
      }
      Robot& robot = *robots_[static_cast<std::size_t>(copy.to)];
      if (const auto* update = std::get_if<MapUpdate>(copy.message.get()))
        for (const CellRun& run : update->runs) robot.map.merge(run);
      robot.exchange->hear(*copy.message, now_);
    }
    in_flight_.insert(in_flight_.end(), later.begin(), later.end());
  }

  std::mt19937_64 random_;
  std::vector<std::unique_ptr<Robot>> robots_;
  std::vector<Copy> in_flight_;
  double now_ = 0.0;
  std::uint64_t step_ = 0;
};

TEST(MapExchange, TwoSecondsAfterAnySilenceAllMapsAreEqual) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    Team team(2 + static_cast<int>(seed % 5), seed);
    team.run(5.0, {}, true);
    Air broken;
    if (seed % 3 == 0) broken.cut = [](RobotId, RobotId) { return true; };
    if (seed % 3 == 1) broken.cut = [](RobotId a, RobotId b) { return a % 2 != b % 2; };
    if (seed % 3 == 2) broken.cut = [](RobotId a, RobotId b) { return a == 0 || b == 0; };
    team.run(3.0 + static_cast<double>(seed), broken, true);
    EXPECT_FALSE(team.equal());
    const std::size_t before = team.bytes;
    team.run(2.0, {}, false);
    EXPECT_TRUE(team.equal());
    EXPECT_LE(team.largest, kMostMessageBytes);
    // Each robot's different tiles at most twice, and small talk.
    const std::size_t whole_map = kOffice.size();
    EXPECT_LE(team.bytes - before, 2 * static_cast<std::size_t>(team.size()) * whole_map + 40000);
    team.run(1.0, {}, false);
    EXPECT_TRUE(team.settled());
  }
}

TEST(MapExchange, LossDelayReorderingAndRepetitionDoNoHarm) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Team team(3, seed);
    const Air bad{.loss = 0.3, .repeat = 0.3, .most_delay_s = 0.5};
    team.run(15.0, bad, true);
    team.run(12.0, bad, false);
    EXPECT_TRUE(team.equal());
    EXPECT_LE(team.largest, kMostMessageBytes);
  }
}

TEST(MapExchange, ALateJoinerHasTheMapWithinTwoSeconds) {
  Team team(4, 7);
  const Air without_3{.cut = [](RobotId a, RobotId b) { return a == 3 || b == 3; }};
  team.run(20.0, without_3, true);
  team.run(2.0, {}, false);
  EXPECT_TRUE(team.equal());
  EXPECT_GT(team.known(3), 5000U);
}

TEST(MapExchange, WhoIsHeardOnlyThroughOthersIsCaughtUpWithToo) {  // a chain: 0 hears 1 hears 2 hears 3
  Team team(4, 3);
  const Air chain{.cut = [](RobotId a, RobotId b) { return std::abs(a - b) > 1; }};
  team.run(10.0, chain, true);
  team.run(6.0, chain, false);
  EXPECT_TRUE(team.equal());
}

TEST(MapExchange, EqualMapsAreNotTalkedAbout) {
  Team team(4, 5);
  team.run(3.0, {}, false);
  EXPECT_EQ(team.repairs, 0U);
  EXPECT_TRUE(team.settled());
}

}  // namespace
}  // namespace outrider::explorer
