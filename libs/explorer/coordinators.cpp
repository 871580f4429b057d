// The table of coordinators and those that need no auction.

#include <algorithm>
#include <limits>

#include "explorer/auction_coordinator.hpp"
#include "explorer/coordinator.hpp"
#include "explorer/dvf_coordinator.hpp"
#include "world/error.hpp"
#include "world/nearest_name.hpp"
#include "world/ray.hpp"

namespace outrider::explorer {
namespace {

/// Yamauchi 1998: each robot drives to its nearest frontier. With reservation, tasks within the sensing range of a
/// team-mate's goal are that team-mate's.
class NearestCoordinator : public Coordinator {
 public:
  explicit NearestCoordinator(bool reserve) : reserve_(reserve) {}

  Decision decide(const Situation& s) override {
    if (!s.needs_task) return {};
    const std::vector<BidEntry> entries = s.tasks({});
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

using Make = std::unique_ptr<Coordinator> (*)(std::string_view, const CoordinatorSettings&);

std::unique_ptr<Coordinator> make_nearest(std::string_view name, const CoordinatorSettings&) {
  return std::make_unique<NearestCoordinator>(name == "nearest-reserved");
}

/// Dai's rules differ in one function.
std::unique_ptr<Coordinator> make_dai(std::string_view name, const CoordinatorSettings& settings) {
  const auction::BidRule rule = *auction::bid_rule(name);
  const TaskGrain grain{.whole_footprint = settings.bids.gain == auction::Gain::kFootprint};
  const auto allocate = [=](const auction::BidTable& table, const auction::Clear& clear) {
    return auction::sequential_auction(table, rule, settings.bids, clear);
  };
  return make_auction_coordinator(grain, allocate, settings.bids.rebid);
}

std::unique_ptr<Coordinator> make_ssi(std::string_view, const CoordinatorSettings& settings) {
  return make_auction_coordinator({.spacing = settings.cluster_spacing},
                                  [](const auction::BidTable& table, const auction::Clear&) {
                                    return auction::first_of_each(auction::all_tasks_auction(table));
                                  });
}

std::unique_ptr<Coordinator> make_burgard(std::string_view, const CoordinatorSettings& settings) {
  return make_auction_coordinator({}, [=](const auction::BidTable& table, const auction::Clear& clear) {
    return auction::burgard_assignment(table, settings.beta, clear);
  });
}

std::unique_ptr<Coordinator> make_hungarian(std::string_view, const CoordinatorSettings& settings) {
  return make_auction_coordinator({.spacing = settings.cluster_spacing},
                                  [](const auction::BidTable& table, const auction::Clear&) {
                                    return auction::hungarian_assignment(table);
                                  });
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
