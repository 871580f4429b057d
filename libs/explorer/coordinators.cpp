// The table of coordinators and those that need no auction.

#include <algorithm>
#include <limits>

#include "explorer/auction_coordinator.hpp"
#include "explorer/bundle_coordinator.hpp"
#include "explorer/coordinator.hpp"
#include "explorer/dvf_coordinator.hpp"
#include "explorer/scout_coordinator.hpp"
#include "world/error.hpp"
#include "world/nearest_name.hpp"
#include "world/ray.hpp"

namespace outrider::explorer {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Yamauchi 1998: each robot drives to its nearest frontier. With reservation, tasks within the sensing range of a
/// team-mate's goal are that team-mate's.
class NearestCoordinator : public Coordinator {
 public:
  explicit NearestCoordinator(bool reserve) : reserve_(reserve) {}

  Decision decide(const Situation& s) override {
    if (!s.needs_task) return {};
    const auto bid = [&](const BidEntry& e) {
      return reserve_ && reserved(s, e.task) ? -kNoLimit : -static_cast<double>(e.distance);
    };
    const auto most = [](const BidEntry& e) { return -static_cast<double>(e.distance); };
    const std::vector<BidEntry> entries = s.tasks({.gains = false, .least_bid = bid, .most_bid = most});
    if (entries.empty()) return {.verdict = Decision::Verdict::kNothing};
    const BidEntry* nearest = nullptr;
    for (const BidEntry& e : entries)
      if ((nearest == nullptr || e.distance < nearest->distance) && !(reserve_ && reserved(s, e.task))) nearest = &e;
    if (nearest == nullptr) return {.verdict = Decision::Verdict::kIdle};
    return {.verdict = Decision::Verdict::kGo, .task = Task{nearest->task, nearest->stand},
            .value = -static_cast<double>(nearest->distance)};
  }

 private:
  static bool reserved(const Situation& s, Cell task) {
    const auto& g = s.map.geometry();
    return std::any_of(s.team.begin(), s.team.end(), [&](const Teammate& mate) {
      return mate.status.goal && distance(g.center(*mate.status.goal), g.center(task)) < mate.status.range &&
             line_of_sight(s.map, *mate.status.goal, task);
    });
  }

  bool reserve_;
};

/// What a robot can lose to team-mates: each takes at most one task. Of a large team only the nearest bid against it, and
/// what others near have is not for sale: some more, for most of the time.
std::size_t rivals(const Situation& s) { return s.known.size() <= kMostAsked ? s.known.size() : kMostAsked + 2; }

/// How many team-mates may crowd a task, at the worst. A bound for a large team would leave no task out: there a robot bids
/// for what is best before anybody crowds it.
double crowd(const Situation& s) { return s.known.size() <= kMostAsked ? static_cast<double>(s.known.size()) : 0.0; }

/// Dai's rules: the influence of team-mates (eq. 2) takes at most max(gamma, 1) each from U.
TaskGrain dai_grain(auction::BidRule rule, const auction::BidParameters& k, const Situation& s) {
  const auto bid = [rule, k, v = s.spec.speed, a = s.explored_rate](const BidEntry& e, double u_p2) {
    return rule({e.gain, u_p2, e.distance, v, a}, k);
  };
  const bool whole = k.gain == auction::Gain::kFootprint;
  if (k.way == auction::Way::kStraight) return {.whole_footprint = whole};  // no search outwards meets these in order
  const double least_u_p2 = -crowd(s) * std::max(k.gamma, 1.0);
  return {.whole_footprint = whole,
          .least_bid = [=](const BidEntry& e) { return bid(e, least_u_p2); },
          .most_bid = [=](const BidEntry& e) { return bid(e, 0.0); },
          .keep = rivals(s) + 1};
}

/// Burgard's: every awarded task takes at most 1 from the utility, which is 1 at most.
TaskGrain burgard_grain(double beta, const Situation& s) {
  const auto bid = [beta, range = s.spec.range](const BidEntry& e, double u) { return u - beta * e.distance / range; };
  const double least_u = 1.0 - crowd(s);
  return {.gains = false,
          .least_bid = [=](const BidEntry& e) { return bid(e, least_u); },
          .most_bid = [=](const BidEntry& e) { return bid(e, 1.0); },
          .keep = rivals(s) + 1};
}

/// An assignment of n robots needs of each only its n nearest tasks: one of them is always left.
TaskGrain nearest_grain(double spacing, const Situation& s) {
  const auto bid = [](const BidEntry& e) { return -static_cast<double>(e.distance); };
  return {.spacing = spacing, .gains = false, .least_bid = bid, .most_bid = bid, .keep = rivals(s) + 1};
}

using Make = std::unique_ptr<Coordinator> (*)(std::string_view, const CoordinatorSettings&);

std::unique_ptr<Coordinator> make_nearest(std::string_view name, const CoordinatorSettings&) {
  return std::make_unique<NearestCoordinator>(name == "nearest-reserved");
}

/// Dai's rules differ in one function.
std::unique_ptr<Coordinator> make_dai(std::string_view name, const CoordinatorSettings& settings) {
  const auction::BidRule rule = *auction::bid_rule(name);
  const auto bid_for = [=](const Situation& s) { return dai_grain(rule, settings.bids, s); };
  const auto allocate = [=](const auction::BidTable& table, const auction::Clear& clear) {
    return auction::sequential_auction(table, rule, settings.bids, clear);
  };
  return make_auction_coordinator(bid_for, allocate, settings.bids.rebid);
}

std::unique_ptr<Coordinator> make_ssi(std::string_view, const CoordinatorSettings& settings) {
  const auto bid_for = [spacing = settings.cluster_spacing](const Situation&) {
    return TaskGrain{.spacing = spacing, .gains = false};
  };
  return make_auction_coordinator(bid_for, [](const auction::BidTable& table, const auction::Clear&) {
    return auction::first_of_each(auction::all_tasks_auction(table));
  });
}

std::unique_ptr<Coordinator> make_burgard(std::string_view, const CoordinatorSettings& settings) {
  const auto bid_for = [beta = settings.beta](const Situation& s) { return burgard_grain(beta, s); };
  return make_auction_coordinator(bid_for, [=](const auction::BidTable& table, const auction::Clear& clear) {
    return auction::burgard_assignment(table, settings.beta, clear);
  });
}

std::unique_ptr<Coordinator> make_hungarian(std::string_view, const CoordinatorSettings& settings) {
  const auto bid_for = [spacing = settings.cluster_spacing](const Situation& s) { return nearest_grain(spacing, s); };
  return make_auction_coordinator(bid_for, [](const auction::BidTable& table, const auction::Clear&) {
    return auction::hungarian_assignment(table);
  });
}

std::unique_ptr<Coordinator> make_scout(std::string_view, const CoordinatorSettings&) {
  return make_scout_coordinator();
}

struct Row {
  CoordinatorInfo info;
  Make make;
};

const std::vector<Row>& table() {
  static const std::vector<Row> rows{
      {{"ia", "IA-A: utility with the team's dispersion minus weighted distance (Dai 2014, eq. 1 to 4)"}, make_dai},
      {{"ea", "EA-A: utility per travel time (Dai 2014, eq. 5)"}, make_dai},
      {{"daa", "DAA-A: EA-A that learns how fast each robot explores (Dai 2014, eq. 6 to 12)"}, make_dai},
      {{"ta", "TA-A: conventional auction, the nearest wins, or unknown cells count (Dai 2014; --bids ta=unseen)"}, make_dai},
      {{"nearest", "every robot to its nearest frontier (Yamauchi 1998)"}, make_nearest},
      {{"nearest-reserved", "nearest frontier that no team-mate is heading for (Yamauchi 1998)"}, make_nearest},
      {{"burgard", "utility that falls near assigned targets, minus distance (Burgard 2005)"}, make_burgard},
      {{"hungarian", "assignment of frontier clusters with the least total travel time"}, make_hungarian},
      {{"ssi", "sequential single-item auctions of all frontier clusters for the makespan (Koenig 2006)"}, make_ssi},
      {{"independent", "discounted nearest frontier, planned anew every second (Matignon 2012, eq. 1)"}, make_dvf_coordinator},
      {{"dvf", "distributed value functions; the silent stay where last heard (Matignon 2012, eq. 3, 7)"}, make_dvf_coordinator},
      {{"dvf-reactive", "distributed value functions that forget the silent (Matignon 2012, eq. 6)"}, make_dvf_coordinator},
      {{"continuous", "free robots bid for one frontier cluster each, the busy keep theirs (Lozenguez 2015, Algorithm 1)"}, make_bundle_coordinator},
      {{"ssa", "bundles of frontier clusters by sequential simultaneous auctions (Lozenguez 2015, section 5)"}, make_bundle_coordinator},
      {{"dssa", "the same, negotiated robot by robot with messages (Lozenguez 2015, section 5.3)"}, make_bundle_coordinator},
      {{"scout", "what team-mates will leave to see per way, weighed again while driving (Outrider's own)"}, make_scout},
  };
  return rows;
}

}  // namespace

const std::vector<CoordinatorInfo>& coordinators() {
  static const std::vector<CoordinatorInfo> infos = [] {
    std::vector<CoordinatorInfo> list;
    for (const Row& row : table()) list.push_back(row.info);
    return list;
  }();
  return infos;
}

std::unique_ptr<Coordinator> make_coordinator(std::string_view name, const CoordinatorSettings& settings) {
  std::vector<std::string> names;
  for (const Row& row : table()) {
    if (row.info.name == name) return row.make(name, settings);
    names.push_back(row.info.name);
  }
  throw InputError("unknown coordinator '" + std::string(name) + "'" + suggestion(name, names));
}

}  // namespace outrider::explorer
