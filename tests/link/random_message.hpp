#pragma once
// Messages of every kind, drawn at random within their limits.

#include <cmath>
#include <random>

#include "world/messages.hpp"

namespace outrider::test {

inline constexpr GridGeometry kWireGrid{0.25, {-3.0, 2.0}, 320, 256};

class MessageSource {
 public:
  explicit MessageSource(std::uint64_t seed, bool longest = false) : random_(seed), longest_(longest) {}

  static constexpr std::size_t kKinds = std::variant_size_v<Message>;

 private:
  std::uint32_t word() { return static_cast<std::uint32_t>(random_()); }
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }
  int number(int n) { return static_cast<int>(below(static_cast<std::uint32_t>(n))); }
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Cell cell() { return {number(kWireGrid.width), number(kWireGrid.height)}; }
  Pose2 pose() { return {real(-50, 50), real(-50, 50), real(-4, 4)}; }
  std::optional<Cell> maybe_cell() { return below(2) ? std::optional(cell()) : std::nullopt; }
  template <class Draw>
  auto list(std::size_t most, Draw&& draw) {
    std::vector<decltype(draw())> elements(longest_ ? most : below(static_cast<std::uint32_t>(most) + 1));
    for (auto& element : elements) element = draw();
    return elements;
  }
  std::string name() {
    std::string text(longest_ ? Introduction::kMostName : 1 + below(20), 'x');
    for (char& c : text) c = "abcXYZ019_-"[below(11)];
    return text;
  }

  Message status(RobotId robot) {
    StatusMessage m{.robot = robot, .seq = word(), .pose = pose(), .goal = maybe_cell()};
    m.way = list(StatusMessage::kMaxWay, [&] { return cell(); });
    m.speed = real(0, 3);
    m.range = real(0, 30);
    m.radius = real(0, 1);
    m.explored_rate = real(0, 9);
    m.done = below(2) == 1;
    m.priority = number(3000) - 1000;
    if (below(2)) m.asks = number(8);
    m.map_hash = random_();
    m.epoch = {word(), number(8)};
    m.heard = list(StatusMessage::kMostHeard, [&] { return number(8); });
    return m;
  }
  Message sheet(RobotId robot) {
    BidSheet m{{number(8), word()}, robot, pose(), real(0.1, 3), real(0.1, 30), real(0, 9), below(2) == 1, maybe_cell()};
    m.entries = list(BidSheet::kMostEntries, [&] {
      return BidEntry{cell(), cell(), static_cast<float>(real(0, 900)), static_cast<float>(real(0, 900))};
    });
    m.epoch = word();
    m.parts = 1 + number(BidSheet::kMostParts);
    m.part = number(m.parts);
    return m;
  }
  Message awards(RobotId robot) {
    Awards m{{robot, word()}, word(), list(Awards::kMostBidders, [&] { return number(500); }), {}};
    m.awards = list(Awards::kMostBidders, [&] { return Award{number(500), cell(), cell(), real(-1e6, 1e6)}; });
    return m;
  }
  double price() { return below(5) == 0 ? HUGE_VAL : real(-100, 100); }
  Message claims(RobotId robot) {
    ClaimSheet m{{number(8), word()}, robot, word(), below(256), list(ClaimSheet::kMostClaims, [&] { return Claim{word(), number(9) - 1}; })};
    for (std::size_t k = 0; k < m.claims.size(); ++k) m.prices.push_back(price());
    m.hash = random_();
    m.content = below(2) == 1;
    m.done = below(2) == 1;
    return m;
  }
  Message plan(RobotId robot) {
    PlanSheet m{{number(8), word()}, robot, word(), real(0, 900), price(), list(256, [&] { return number(9) - 1; })};
    m.without = random_();
    m.searched = below(2) == 1;
    return m;
  }
  Message introduction(RobotId robot) {
    return Introduction{robot, {name(), pose(), real(0, 3), real(0, 30), real(0, 6), number(1000), real(0, 1)},
                        kWireGrid, name(), 1 + number(500), real(0.5, 20)};
  }

 public:
  Message draw(std::size_t kind, RobotId robot) {
    switch (kind) {
      case 0: return status(robot);
      case 1: return MapUpdate{robot, word(), list(MapUpdate::kMostRuns, [&] {
                       return CellRun{below(60000), static_cast<std::uint8_t>(below(256)), static_cast<std::uint8_t>(below(256))};
                     })};
      case 2: return MapDigest{robot, below(80), list(MapDigest::kMostMarks, [&] { return TileMark{word(), word()}; })};
      case 3: return TileRequest{robot, number(8), list(TileRequest::kMostTiles, [&] { return below(80); })};
      case 4: return MapTile{robot, below(80), list(MapTile::kMostCells, [&] { return static_cast<std::uint8_t>(below(256)); })};
      case 5: return RoundOpen{{robot, word()}, list(RoundOpen::kMostHeard, [&] { return number(500); }),
                               list(RoundOpen::kMostAsked, [&] { return number(500); })};
      case 6: return sheet(robot);
      case 7: return awards(robot);
      case 8: return introduction(robot);
      case 9: return claims(robot);
      case 10: return TaskOffer{{number(8), word()}, robot, number(8), word(), below(256), word(), price()};
      case 11: return TaskAnswer{{number(8), word()}, robot, number(8), word(), static_cast<TaskAnswer::Verdict>(below(3))};
      default: return plan(robot);
    }
  }

 private:
  std::mt19937_64 random_;
  bool longest_;
};

}  // namespace outrider::test
