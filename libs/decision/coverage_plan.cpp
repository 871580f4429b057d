#include "decision/coverage_plan.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "decision/tour_moves.hpp"

namespace outrider::decision {
namespace {

constexpr std::int16_t kNever = std::numeric_limits<std::int16_t>::max();
constexpr std::int16_t kLast = 4095;  // what is seen later is seen in this tick
constexpr double kTicks = 512.0;      // in the time that a perfect team would need
constexpr double kBadly = 0.1;        // of speed x range is swept badly

double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }

auto at(auto& list, std::size_t k) { return list.begin() + static_cast<std::ptrdiff_t>(k); }

}  // namespace

CoveragePlanner::CoveragePlanner(CoverageGround& ground, std::vector<CoverageRobot> robots,
                                 const CoverageOptions& options)
    : ground_(ground),
      robots_(std::move(robots)),
      options_(options),
      open_((ground.nodes() + 63) / 64, 0),
      unit_(ground.nodes(), 0),
      seen_in_(kLast + 1) {
  double area = 0.0;  // [m^2]
  for (Node node = 0; node < ground.nodes(); ++node) {
    if (ground.weight(node) == 0) continue;
    open_[node / 64] |= std::uint64_t{1} << (node % 64);
    unit_[node] = static_cast<std::uint32_t>(units_.size());
    units_.push_back(node);
    total_ += ground.weight(node);
    area += ground.geometry().cell_area();
  }
  first_.assign(units_.size(), kNever);
  double rate = 0.0;  // [m^2/s]
  for (const CoverageRobot& robot : robots_) rate += robot.speed * robot.range;
  sweep_rate_ = kBadly * rate * total_ / std::max(area, 1e-9);
  tick_s_ = std::max(area, 1e-9) / (2.0 * rate) / kTicks;
}

double CoveragePlanner::apart(Node a, Node b) const {
  const Cell ca = ground_.geometry().cell_at(a), cb = ground_.geometry().cell_at(b);
  return std::hypot(ca.x - cb.x, ca.y - cb.y);
}

void CoveragePlanner::run(std::size_t robot, const Tour& tour, Run& result) {
  const CoverageRobot& r = robots_[robot];
  const double ticks_per_metre = 1.0 / (r.speed * tick_s_);
  unseen_ = open_;
  result.seen.assign(units_.size(), kNever);
  result.metres = 0.0;
  const auto look = [&](Node from) {
    const auto now = static_cast<Tick>(std::min<double>(kLast, result.metres * ticks_per_metre));
    for (const CoverageGround::Word& word : ground_.view(from, r.range)) {
      std::uint64_t fresh = unseen_[word.index] & word.bits;
      unseen_[word.index] ^= fresh;
      for (; fresh != 0; fresh &= fresh - 1)
        result.seen[unit_[word.index * 64 + static_cast<std::uint32_t>(std::countr_zero(fresh))]] = now;
    }
  };
  Node here = r.at;
  look(here);
  for (const Node to : tour) {
    const CoverageGround::Leg& leg = ground_.leg(here, to);
    for (const Node node : leg.nodes) {
      result.metres += ground_.step_m(here, node);
      here = node;
      look(here);
    }
  }
}

double CoveragePlanner::cost_of(const std::vector<const Run*>& runs) {
  double metres = 0.0;
  std::fill(first_.begin(), first_.end(), kNever);
  for (const Run* run : runs) {
    metres += run->metres;
    for (std::size_t k = 0; k < first_.size(); ++k) first_[k] = std::min(first_[k], run->seen[k]);
  }
  std::fill(seen_in_.begin(), seen_in_.end(), 0);
  double never = 0.0;
  for (std::size_t k = 0; k < first_.size(); ++k) {
    if (first_[k] == kNever)
      never += ground_.weight(units_[k]);
    else
      seen_in_[static_cast<std::size_t>(first_[k])] += ground_.weight(units_[k]);
  }
  const double tail = options_.tail * total_;
  double left = total_ - never, ticks = 0.0;
  for (std::size_t k = 0; left > 0.0; ++k) {
    left -= seen_in_[k];
    ticks += std::min(1.0, (left + never) / tail);
  }
  const double over = std::max(0.0, never - tail), under = never - over;
  return tick_s_ * ticks + options_.metre_cost * metres + (over + under * under / tail / 2.0) / sweep_rate_;
}

double CoveragePlanner::cost(const CoverageTours& tours) {
  std::vector<Run> runs(robots_.size());
  std::vector<const Run*> all;
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    run(r, tours[r], runs[r]);
    all.push_back(&runs[r]);
  }
  return cost_of(all);
}

CoverageTours CoveragePlanner::improve(CoverageTours tours, int evaluations, std::mt19937_64& random) {
  random_ = &random;
  if (units_.empty()) return tours;
  std::vector<Run> runs(robots_.size()), others(robots_.size());
  std::vector<const Run*> now, then;
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    run(r, tours[r], runs[r]);
    now.push_back(&runs[r]);
  }
  double cost = cost_of(now), best_cost = cost;
  CoverageTours best = tours;
  std::vector<Tick> first = first_;
  for (int k = 0; k < evaluations; ++k) {
    const double part = static_cast<double>(k) / evaluations;
    const double heat = options_.hot * std::pow(options_.cold / options_.hot, part) * best_cost;
    CoverageTours other = tours;
    const std::vector<std::size_t> changed = change(other);
    then = now;
    for (const std::size_t r : changed) {
      run(r, other[r], others[r]);
      then[r] = &others[r];
    }
    const double other_cost = cost_of(then);
    if (other_cost > cost && std::exp((cost - other_cost) / heat) < uniform(random)) {
      first_ = first;
      continue;
    }
    first = first_;
    for (const std::size_t r : changed) std::swap(runs[r], others[r]);
    tours = std::move(other);
    cost = other_cost;
    if (cost < best_cost) best_cost = cost, best = tours;
  }
  return best;
}

/// A node within about `range` [m] of `node`, drivable when some tries find one.
CoveragePlanner::Node CoveragePlanner::near(Node node, double range) {
  const GridGeometry& g = ground_.geometry();
  const Cell c = g.cell_at(node);
  const int reach = std::max(1, static_cast<int>(std::lround(range / g.resolution)));
  const auto side = static_cast<std::size_t>(2 * reach + 1);
  for (int k = 0; k < 8; ++k) {
    const int dx = static_cast<int>(below(side)) - reach, dy = static_cast<int>(below(side)) - reach;
    const Cell n{c.x + dx, c.y + dy};
    if (g.contains(n) && ground_.drivable(static_cast<Node>(g.index(n)))) return static_cast<Node>(g.index(n));
  }
  return node;
}

/// Of some units the one that is seen last.
CoveragePlanner::Node CoveragePlanner::late() {
  constexpr int kDraws = 5;
  std::size_t latest = below(units_.size());
  for (int k = 1; k < kDraws; ++k)
    if (const std::size_t other = below(units_.size()); first_[other] > first_[latest]) latest = other;
  return units_[latest];
}

/// Before which way-point `node` makes the tour least longer, by straight lines.
std::size_t CoveragePlanner::best_place(std::size_t robot, const Tour& tour, Node node) const {
  double least = std::numeric_limits<double>::infinity();
  std::size_t place = 0;
  Node before = robots_[robot].at;
  for (std::size_t k = 0; k <= tour.size(); ++k) {
    const bool last = k == tour.size();
    const double more = apart(before, node) + (last ? 0.0 : apart(node, tour[k]) - apart(before, tour[k]));
    if (more < least) least = more, place = k;
    if (!last) before = tour[k];
  }
  return place;
}

/// Moves a few way-points to where they fit, or anywhere.
void CoveragePlanner::move_some(CoverageTours& tours, std::size_t from, std::size_t i, std::size_t to) {
  const std::size_t n = std::min(tours[from].size() - i, 1 + below(4));
  Tour some = take_stretch(tours[from], i, n);
  const std::size_t j = below(3) != 0 ? best_place(to, tours[to], some.front()) : below(tours[to].size() + 1);
  if (below(2) == 0) std::reverse(some.begin(), some.end());
  tours[to].insert(at(tours[to], j), some.begin(), some.end());
}

void CoveragePlanner::exchange_tails(CoverageTours& tours, std::size_t a, std::size_t i, std::size_t b) {
  if (a == b) return;
  const std::size_t j = below(2) != 0 ? best_place(b, tours[b], tours[a][i]) : below(tours[b].size() + 1);
  decision::exchange_tails(tours[a], i, tours[b], j);
}

/// Changes the plan at random; returns whose tours.
std::vector<std::size_t> CoveragePlanner::change(CoverageTours& tours) {
  const std::size_t a = below(tours.size()), b = below(tours.size());
  Tour& tour = tours[a];
  const double range = robots_[a].range;
  const std::size_t i = tour.empty() ? 0 : below(tour.size());
  std::vector<std::size_t> changed{a};
  switch (tour.empty() ? 2 : below(8)) {
    case 0:
    case 1:
      move_some(tours, a, i, b);
      if (b != a) changed.push_back(b);
      break;
    case 2:
    case 3: {  // see something earlier
      const Node node =
          below(2) != 0 ? near(late(), 0.7 * range) : near(tour.empty() ? robots_[a].at : tour[i], 2.0 * range);
      tour.insert(at(tour, best_place(a, tour, node)), node);
      break;
    }
    case 4:
      tour[i] = near(tour[i], range);
      break;
    case 5:
      tour.erase(at(tour, i));
      break;
    case 6:
      reverse_stretch(tour, i, below(tour.size()));
      break;
    default:
      exchange_tails(tours, a, i, b);
      if (b != a) changed.push_back(b);
  }
  return changed;
}

}  // namespace outrider::decision
