#pragma once
// What a task is worth to a robot: the bid rules of Dai, Yao and Zhao 2014, one function each, and the baselines'.
// Areas are in m^2 and lengths in m, so that a rule means the same on any cell size (the paper's cells are 1 m).

#include <optional>
#include <string_view>

namespace outrider::auction {

/// U_p1, "the size of the detectable subset": what counts as detectable.
enum class Gain {
  kUnseen,     ///< unknown cells within range and in line of sight
  kFootprint,  ///< every cell within range and in line of sight, known or not
};
/// D_p, "the distance from the current location to the frontier cell".
enum class Way {
  kShortest,  ///< along the shortest safe path on the known map
  kStraight,  ///< as the crow flies
};
/// What a task is worth to TA-A.
enum class TaUtility {
  kConstant,  ///< the same everywhere (Burgard's first part): the nearest wins
  kUnseen,    ///< U_p1 (Sheng 2006, Simmons 2000), minus rho D
};
/// Who is served next.
enum class Turn {
  kBestBid,     ///< the best bid of all robots that have no task yet
  kRobotOrder,  ///< R_1, R_2, ..., each its own best
};
/// Who bids when the first robot has finished its task.
enum class Rebid {
  kEverybody,  ///< "unfinished tasks are reauctioned in the next cycle"
  kFinisher,   ///< robots under way keep their tasks, which count as their targets
};

/// The free scalars of the rules, and the paper's ambiguous points as named choices. docs/equations.md tells which
/// reading is the default and what the others cost.
struct BidParameters {
  double rho = 2.0;     ///< weight of the distance, eq. 3 [m^2/m]; by measurement, docs/benches.md
  double gamma = 1.0;   ///< influence of team-mates without a target, eq. 2
  double weight = 1.0;  ///< of the whole second part U_p2 [m^2]
  double alpha = 0.3;   ///< expected utility per explored rate, eq. 10 [s]
  Gain gain = Gain::kUnseen;
  Way way = Way::kShortest;
  bool sight = true;  ///< team-mates behind something have no influence, eq. 2
  TaUtility ta = TaUtility::kConstant;
  Turn turn = Turn::kBestBid;
  Rebid rebid = Rebid::kEverybody;
};

/// One robot's view of one task while an auction runs.
struct BidTerms {
  double u_p1 = 0.0;  ///< U_p1: unseen area within its range from the task [m^2]
  double u_p2 = 0.0;  ///< U_p2: influence of the team-mates, eq. 2, <= 0
  double d_p = 0.0;   ///< D_p: shortest safe way to the task [m]
  double v = 1.0;     ///< the robot's speed [m/s]
  double a_k = 0.0;   ///< A(k-1): area it explored per second so far, eq. 8 [m^2/s]
};

/// Floor of D_p [m]: a task under the robot's feet would otherwise be worth infinitely much to eq. 5 and 12.
inline constexpr double kShortestWay = 0.1;

double bid_ia(const BidTerms& t, const BidParameters& k);   ///< IA-A: E = U - rho D (Dai 2014, eq. 1 to 3)
double bid_ea(const BidTerms& t, const BidParameters& k);   ///< EA-A: E = U / (D / v) (eq. 5)
double bid_daa(const BidTerms& t, const BidParameters& k);  ///< DAA-A: E = (U + alpha A(k-1)) / (D / v) (eq. 10 to 12)
double bid_ta(const BidTerms& t, const BidParameters& k);   ///< TA-A: E = -D, or U_p1 - rho D: BidParameters::ta

using BidRule = double (*)(const BidTerms&, const BidParameters&);

/// The rule called "ia", "ea", "daa" or "ta".
std::optional<BidRule> bid_rule(std::string_view name);

/// A^i(k): area explored per second (Dai 2014, eq. 6), kept by the recursion of eq. 8 and 9.
class ExploredRate {
 public:
  /// One auction period: `delta_a` = area explored by the robot in it [m^2], `period` = T(k) > 0 [s].
  void add(double delta_a, double period);
  double value() const { return a_; }  ///< A(k) [m^2/s]; 0 before the first period

 private:
  double a_ = 0.0;  // A(k)
  double p_ = 0.0;  // P(k) = sum of T [s]
};

}  // namespace outrider::auction
