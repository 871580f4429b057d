#include "decision/tour_plan.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace outrider::decision {
namespace {

std::uint64_t key(HopedWorld::Node from, HopedWorld::Node to) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(from)) << 32 | static_cast<std::uint32_t>(to);
}

}  // namespace

void TourPlanner::begin(std::vector<Tourist> team) {
  team_ = std::move(team);
  if (revision_ != world_.revision() || legs_.size() > 20000) legs_.clear();
  revision_ = world_.revision();
  stamp_.resize(world_.nodes(), 0);
  metres_.resize(world_.nodes());
  from_.resize(world_.nodes());
  gains_.resize(world_.nodes());
  live_.resize(world_.range_classes());
  for (auto& views : live_) views.resize(world_.nodes());
  ++live_round_;
  patches_.clear();
  pixels_ = 0;
  for (const std::uint64_t tile : world_.unseen()) pixels_ += std::popcount(tile);
}

void TourPlanner::start_search(Node n) {
  if (++round_ == 0) {
    std::fill(stamp_.begin(), stamp_.end(), 0U);
    round_ = 1;
  }
  open_.clear();
  reach(n, HopedWorld::kNone, 0.0F, 0.0F);
}

bool TourPlanner::reach(Node n, Node from, float metres, float key) {
  const auto i = static_cast<std::size_t>(n);
  if (stamp_[i] == round_ && metres_[i] <= metres) return false;
  stamp_[i] = round_;
  metres_[i] = metres;
  from_[i] = from;
  open_.push_back({key, n});
  std::push_heap(open_.begin(), open_.end());
  return true;
}

const TourPlanner::Leg& TourPlanner::leg(Node from, Node to) {
  const auto [entry, fresh] = legs_.try_emplace(key(from, to));
  Leg& leg = entry->second;
  if (!fresh || from == to) return leg;
  start_search(from);
  while (!open_.empty()) {
    std::pop_heap(open_.begin(), open_.end());
    const Open top = open_.back();
    open_.pop_back();
    if (top.node == to) break;
    const float metres = metres_[static_cast<std::size_t>(top.node)];
    if (top.key > metres + static_cast<float>(world_.straight_m(top.node, to)) + 1e-3F) continue;  // outdated
    for (const HopedWorld::Edge& edge : world_.edges(top.node)) {
      const float m = metres + edge.metres;
      reach(edge.to, top.node, m, m + static_cast<float>(world_.straight_m(edge.to, to)));
    }
  }
  if (stamp_[static_cast<std::size_t>(to)] == round_) trace(from, to, leg);
  return leg;
}

/// Writes down the way that the last search found.
void TourPlanner::trace(Node from, Node to, Leg& leg) const {
  leg.nodes.clear();
  leg.metres.clear();
  for (Node n = to; n != from; n = from_[static_cast<std::size_t>(n)]) leg.nodes.push_back(n);
  std::reverse(leg.nodes.begin(), leg.nodes.end());
  for (const Node n : leg.nodes) leg.metres.push_back(metres_[static_cast<std::size_t>(n)]);
}

/// A node's view of what was unseen when the situation began.
std::span<const HopedWorld::Patch> TourPlanner::live_view(std::size_t robot, Node n) {
  const int kind = team_[robot].range_class;
  Live& live = live_[static_cast<std::size_t>(kind)][static_cast<std::size_t>(n)];
  if (live.round != live_round_) {
    live = {live_round_, static_cast<std::uint32_t>(patches_.size()), 0};
    for (const HopedWorld::Patch& patch : world_.view(kind, n))
      if (const std::uint64_t pixels = patch.pixels & world_.unseen()[patch.tile]; pixels != 0)
        patches_.push_back({patch.tile, pixels});
    live.end = static_cast<std::uint32_t>(patches_.size());
  }
  return {patches_.data() + live.begin, patches_.data() + live.end};
}

int TourPlanner::see(std::size_t robot, Node n) {
  int count = 0;
  for (const HopedWorld::Patch& patch : live_view(robot, n)) {
    const std::uint64_t fresh = left_[patch.tile] & patch.pixels;
    if (fresh == 0) continue;
    count += std::popcount(fresh);
    left_[patch.tile] &= ~fresh;
  }
  left_count_ -= count;
  return count;
}

/// Sends a robot towards the next stop that is not where it is; false at the end of its tour.
bool TourPlanner::set_out(std::size_t robot, const Tours& tours) {
  Walker& w = walkers_[robot];
  const auto& tour = tours[robot];
  while (w.stop < tour.size()) {
    w.leg = &leg(w.at, tour[w.stop]);
    w.leg_begin = w.time;
    w.k = 0;
    if (!w.leg->nodes.empty()) return true;
    ++w.stop;
  }
  return false;
}

/// Drives all tours at once, in the order of time.
void TourPlanner::run(const Tours& tours) {
  left_ = world_.unseen();
  left_count_ = pixels_;
  walkers_.resize(team_.size());
  clock_.clear();
  const auto step = [&](std::size_t r) {
    const Walker& w = walkers_[r];
    const double arrival = w.leg_begin + w.leg->metres[w.k] / team_[r].speed;
    clock_.emplace_back(-arrival, r);
    std::push_heap(clock_.begin(), clock_.end());
  };
  for (std::size_t r = 0; r < team_.size(); ++r) {
    Walker& w = walkers_[r];
    w.time = 0.0;
    w.at = team_[r].at;
    w.stop = 0;
    w.fruitful.assign(tours[r].size(), 0);
    see(r, team_[r].at);
    if (set_out(r, tours)) step(r);
  }
  while (!clock_.empty() && left_count_ > 0) {
    std::pop_heap(clock_.begin(), clock_.end());
    const auto [minus_time, r] = clock_.back();
    clock_.pop_back();
    Walker& w = walkers_[r];
    w.time = -minus_time;
    w.at = w.leg->nodes[w.k++];
    if (see(r, w.at) > 0) w.fruitful[w.stop] = 1;
    if (w.k == w.leg->nodes.size() && !(++w.stop, set_out(r, tours))) continue;
    step(r);
  }
}

int TourPlanner::left_after(const Tours& tours) {
  run(tours);
  return left_count_;
}

double TourPlanner::worth(const HopedWorld::Patch& patch) const {
  const std::uint64_t fresh = left_[patch.tile] & patch.pixels;
  if (fresh == 0) return 0.0;
  return std::popcount(fresh) * (1.0 + settings_.tidiness * (1.0 - std::popcount(left_[patch.tile]) / 64.0));
}

/// What a robot coming from `parent` sees newly at `n`.
double TourPlanner::fresh_from(std::size_t robot, Node n, Node parent) {
  live_view(robot, n);  // both first: either may move the patches
  const auto before = live_view(robot, parent);
  double sum = 0.0;
  for (HopedWorld::Patch patch : live_view(robot, n)) {
    for (const HopedWorld::Patch& other : before)
      if (other.tile == patch.tile) patch.pixels &= ~other.pixels;
    sum += worth(patch);
  }
  return sum;
}

/// The node whose way there shows this robot most per time, some sensing ranges away at most when that shows anything.
HopedWorld::Node TourPlanner::best_next(std::size_t robot) {
  const double least_m = settings_.least_ranges * world_.range(team_[robot].range_class);
  const double reach_m = settings_.leg_ranges * world_.range(team_[robot].range_class);
  Node best = HopedWorld::kNone;
  Node nearer = HopedWorld::kNone;
  double best_rate = 0.0, nearer_rate = 0.0;
  start_search(walkers_[robot].at);
  while (!open_.empty()) {
    std::pop_heap(open_.begin(), open_.end());
    const Open top = open_.back();
    open_.pop_back();
    const auto i = static_cast<std::size_t>(top.node);
    const float metres = metres_[i];
    if (top.key > metres) continue;
    if (metres > reach_m && best != HopedWorld::kNone) break;
    gains_[i] = 0.0F;
    if (from_[i] != HopedWorld::kNone) {
      const float before = gains_[static_cast<std::size_t>(from_[i])];
      gains_[i] = before + static_cast<float>(fresh_from(robot, top.node, from_[i]));
      const double rate = static_cast<double>(gains_[i] / metres);
      double& highest = metres < least_m ? nearer_rate : best_rate;
      if (rate > highest) {
        highest = rate;
        (metres < least_m ? nearer : best) = top.node;
      }
    }
    for (const HopedWorld::Edge& edge : world_.edges(top.node))
      reach(edge.to, top.node, metres + edge.metres, metres + edge.metres);
  }
  if (nearer != HopedWorld::kNone && nearer_rate > settings_.least_gain * best_rate) best = nearer;
  // The way that was valued is the way to go: another of the same length may show nothing.
  if (best != HopedWorld::kNone) trace(walkers_[robot].at, best, legs_[key(walkers_[robot].at, best)]);
  return best;
}

void TourPlanner::prune(Tours& tours) {
  run(tours);
  for (std::size_t r = 0; r < team_.size(); ++r) {
    std::vector<Node> kept;
    for (std::size_t k = 0; k < tours[r].size(); ++k)
      if (walkers_[r].fruitful[k] || k < lowest(r, tours[r])) kept.push_back(tours[r][k]);
    tours[r] = std::move(kept);
  }
}

void TourPlanner::complete(Tours& tours) {
  run(tours);
  std::vector<std::size_t> idle;
  for (std::size_t r = 0; r < team_.size(); ++r)
    if (tours[r].size() < settings_.most_stops) idle.push_back(r);
  while (left_count_ > 0 && !idle.empty()) {
    const auto first = std::min_element(idle.begin(), idle.end(), [&](std::size_t a, std::size_t b) {
      return walkers_[a].time < walkers_[b].time;
    });
    const std::size_t r = *first;
    const Node next = best_next(r);
    if (next == HopedWorld::kNone) {
      idle.erase(first);
      continue;
    }
    tours[r].push_back(next);
    if (tours[r].size() >= settings_.most_stops) idle.erase(first);
    Walker& w = walkers_[r];
    const Leg& way = leg(w.at, next);
    for (const Node n : way.nodes) see(r, n);
    w.time += way.metres.back() / team_[r].speed;
    w.at = next;
  }
}

}  // namespace outrider::decision
