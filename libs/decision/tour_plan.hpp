#pragma once
// Tours for a whole team through the hoped-for world, with everything that is seen on the way.

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "decision/hoped_world.hpp"

namespace outrider::decision {

/// A robot as the plan sees it.
struct Tourist {
  HopedWorld::Node at = HopedWorld::kNone;
  double speed = 1.0;         ///< [m/s]
  int range_class = 0;        ///< of HopedWorld
  bool first_fixed = false;   ///< its first stop is where it is heading, and not ours to change
};

/// For each robot the nodes to pass by, in order.
using Tours = std::vector<std::vector<HopedWorld::Node>>;

/// Parameters of TourPlanner.
struct TourPlanSettings {
  double tidiness = 1.0;       ///< a pixel is worth up to this much more when what is around it has been seen
  double leg_ranges = 4.0;     ///< a stop is at most this far ahead, in sensing ranges, when anything shows within
  double least_ranges = 1.5;   ///< and at least this far,
  double least_gain = 1.3;     ///< unless something nearer shows more per time by this factor
  std::size_t most_stops = 1;  ///< of one robot
};

/// Plans by simulation: all robots drive their tours through the hoped-for world, each at its own speed and with its
/// own range; what one sees first is nothing new to the others. Deterministic.
class TourPlanner {
 public:
  TourPlanner(HopedWorld& world, const TourPlanSettings& settings) : world_(world), settings_(settings) {}

  /// A new situation: these robots, and the world as it is now.
  void begin(std::vector<Tourist> team);
  /// Drops stops on whose way nothing new is seen.
  void prune(Tours& tours);
  /// Adds stops until all is seen that can be seen: always the robot that is free first, always the most seen per time.
  void complete(Tours& tours);
  /// A way, without its beginning, and how far each of its nodes is from there [m].
  struct Leg {
    std::vector<HopedWorld::Node> nodes;
    std::vector<float> metres;
  };
  /// The way from `from` to `to` by A*; empty when they are the same or there is none.
  const Leg& leg(HopedWorld::Node from, HopedWorld::Node to);
  /// Pixels left unseen when all robots have driven their tours.
  int left_after(const Tours& tours);

 private:
  using Node = HopedWorld::Node;
  struct Walker {
    double time = 0.0;            // at which it was at `at`
    double leg_begin = 0.0;       // at which the leg began
    Node at = HopedWorld::kNone;
    std::size_t stop = 0;         // of its tour, that it is heading for
    const Leg* leg = nullptr;
    std::size_t k = 0;            // node of the leg that comes next
    std::vector<std::uint8_t> fruitful;  // by stop: something new is seen on the way there
  };

  std::span<const HopedWorld::Patch> live_view(std::size_t robot, Node n);
  int see(std::size_t robot, Node n);
  bool set_out(std::size_t robot, const Tours& tours);
  void run(const Tours& tours);
  void trace(Node from, Node to, Leg& leg) const;
  double fresh_from(std::size_t robot, Node n, Node parent);
  double worth(const HopedWorld::Patch& patch) const;
  Node best_next(std::size_t robot);
  std::size_t lowest(std::size_t robot, const std::vector<Node>& tour) const {
    return team_[robot].first_fixed && !tour.empty() ? 1 : 0;
  }

  HopedWorld& world_;
  TourPlanSettings settings_;
  std::vector<Tourist> team_;
  std::uint64_t revision_ = 0;
  std::unordered_map<std::uint64_t, Leg> legs_;  // looked up, never iterated

  struct Live {
    std::uint32_t round = 0, begin = 0, end = 0;
  };
  std::vector<std::vector<Live>> live_;      // by range class and node: its view of what was unseen at begin()
  std::vector<HopedWorld::Patch> patches_;   // of all live views
  std::uint32_t live_round_ = 0;

  HopedWorld::Picture left_;  // what is still unseen in the simulation
  int pixels_ = 0, left_count_ = 0;
  std::vector<Walker> walkers_;
  std::vector<std::pair<double, std::size_t>> clock_;  // heap of arrivals

  struct Open {
    float key;
    Node node;
    bool operator<(const Open& other) const { return key > other.key || (key == other.key && node > other.node); }
  };
  std::vector<Open> open_;
  std::vector<float> metres_;
  std::vector<Node> from_;
  std::vector<float> gains_;
  std::vector<std::uint32_t> stamp_;
  std::uint32_t round_ = 0;
  void start_search(Node n);
  bool reach(Node n, Node from, float metres, float key);
};

}  // namespace outrider::decision
