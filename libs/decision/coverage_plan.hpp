#pragma once
// Tours of a team that soon see what there is to see.

#include <cstdint>
#include <random>
#include <vector>

#include "decision/coverage_ground.hpp"

namespace outrider::decision {

struct CoverageRobot {
  CoverageGround::Node at = 0;
  double speed = 1.0;  ///< [m/s]
  double range = 1.0;  ///< of its sensor [m]
};

struct CoverageOptions {
  double tail = 0.1;               ///< this part of everything counts less the less of it is left
  double metre_cost = 0.01;        ///< of all that is driven, so that way-points that do nothing go [s/m]
  double hot = 6e-4, cold = 3e-5;  ///< temperature of the search at its ends, parts of the cost
};

using CoverageTours = std::vector<std::vector<CoverageGround::Node>>;

/// Local search over tours of way-points, one a robot, that see on the way. What it makes small is smooth enough for a
/// search and near to the time until almost everything is seen: with u(t) the part of the team's area unseen at t,
///   integral of min(1, u(t) / tail) dt,
/// as if what a plan never sees were swept badly after its end.
class CoveragePlanner {
 public:
  /// `ground` is asked for ways and views and must outlive this.
  CoveragePlanner(CoverageGround& ground, std::vector<CoverageRobot> robots, const CoverageOptions& options);

  /// The best plan that simulated annealing with `evaluations` changed plans finds from `tours` on: way-points moved
  /// within and between tours, put in, left out; stretches reversed; tails exchanged. O(steps of two tours + nodes x
  /// robots) an evaluation, some 20 microseconds for four robots and 2500 nodes.
  CoverageTours improve(CoverageTours tours, int evaluations, std::mt19937_64& random);
  double cost(const CoverageTours& tours);  ///< [s]

 private:
  using Node = CoverageGround::Node;
  using Tour = std::vector<Node>;
  using Tick = std::int16_t;
  /// How one robot's tour goes.
  struct Run {
    std::vector<Tick> seen;  // when it first sees each unit
    double metres = 0.0;
  };

  void run(std::size_t robot, const Tour& tour, Run& result);
  double cost_of(const std::vector<const Run*>& runs);
  std::vector<std::size_t> change(CoverageTours& tours);
  void move_some(CoverageTours& tours, std::size_t from, std::size_t i, std::size_t to);
  void exchange_tails(CoverageTours& tours, std::size_t a, std::size_t i, std::size_t b);
  std::size_t below(std::size_t n) { return static_cast<std::size_t>((*random_)() % n); }
  Node near(Node node, double range);
  Node late();
  std::size_t best_place(std::size_t robot, const Tour& tour, Node node) const;
  double apart(Node a, Node b) const;

  CoverageGround& ground_;
  std::vector<CoverageRobot> robots_;
  CoverageOptions options_;
  std::mt19937_64* random_ = nullptr;  // during improve()
  std::vector<Node> units_;            // nodes that weigh something
  std::vector<std::uint64_t> open_;    // the same as bits
  std::vector<std::uint32_t> unit_;    // number of a node's unit
  double total_ = 0.0;                 // weight of all units [cells]
  double sweep_rate_ = 0.0;            // of a team that sweeps badly [cells/s]
  double tick_s_ = 1.0;
  std::vector<std::uint64_t> unseen_;  // by the robot that runs
  std::vector<Tick> first_;            // when the team first sees each unit, in the plan evaluated last
  std::vector<int> seen_in_;           // weight of what it first sees in each tick
};

}  // namespace outrider::decision
