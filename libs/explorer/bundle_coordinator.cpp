#include "explorer/bundle_coordinator.hpp"

#include <algorithm>
#include <deque>
#include <limits>

#include "auction/hand_over.hpp"
#include "auction/ssa.hpp"
#include "decision/distance_field.hpp"
#include "explorer/auction_coordinator.hpp"
#include "explorer/team_costs.hpp"

namespace outrider::explorer {
namespace {

constexpr double kNoc = 0.1;         // eq. 11, of D_max
constexpr std::size_t kMostTasks = 24;
constexpr double kTalkTimeout = 3.0; // [s] of negotiation; then everybody goes with what it has
constexpr double kRounding = 1e-3;   // [m]

/// A task of a round with the place to do it from.
struct Stop {
  Cell task, stand;
};

/// Algorithm 1 among the free; the busy keep what they drive to.
std::vector<Award> continuous_awards(const auction::BidTable& table) {
  std::vector<Award> awards;
  std::vector<char> taken(table.tasks(), 0), busy(table.robots(), 0);
  for (std::size_t i = 0; i < table.robots(); ++i)
    for (std::size_t p = 0; p < table.tasks(); ++p)
      if (const BidSheet& sheet = table.sheet(i); sheet.busy && sheet.goal == table.task(p) && table.entry(i, p) && !taken[p]) {
        awards.push_back(table.award(i, p, -static_cast<double>(table.entry(i, p)->distance)));
        taken[p] = busy[i] = 1;
      }
  std::vector<double> utilities;
  for (std::size_t i = 0; i < table.robots(); ++i)
    for (std::size_t p = 0; p < table.tasks(); ++p) {
      const BidEntry* entry = busy[i] || taken[p] ? nullptr : table.entry(i, p);
      utilities.push_back(entry ? -static_cast<double>(entry->distance) / table.sheet(i).speed : -auction::kImpossible);
    }
  for (const auto& match : auction::simultaneous_auctions(utilities, static_cast<int>(table.robots()), static_cast<int>(table.tasks()))) {
    const auto i = static_cast<std::size_t>(match.robot), p = static_cast<std::size_t>(match.task);
    awards.push_back(table.award(i, p, -static_cast<double>(table.entry(i, p)->distance)));
  }
  return awards;
}

/// A complete topological map over the stops, with a start for each robot. `from[i][p]`: robot i's way to stop p [m].
decision::TopoMission frontier_mission(const Situation& s, const std::vector<Stop>& stops,
                                       const std::vector<std::vector<double>>& from, const std::vector<double>& speeds) {
  decision::TopoMission mission;
  const auto at = [&](std::size_t k) { return static_cast<int>(k); };
  for (std::size_t p = 0; p < stops.size(); ++p) {
    mission.map.waypoints.push_back({std::to_string(p), {}, {}, -1});
    mission.goals.push_back(at(p));
  }
  decision::DistanceField field;
  for (std::size_t p = 0; p < stops.size(); ++p) {
    field.compute(s.passable.mask(), std::span(&stops[p].stand, 1));
    for (std::size_t q = 0; q < stops.size(); ++q)
      if (p != q && field.reached(stops[q].stand))
        mission.map.paths.push_back(decision::certain_path(at(q), at(p), std::max(kRounding, field.metres(stops[q].stand))));
  }
  for (std::size_t i = 0; i < from.size(); ++i) {
    const std::size_t start = mission.map.waypoints.size();
    mission.map.waypoints.push_back({"start" + std::to_string(i), {}, {}, -1});
    mission.robots.push_back({"", at(start), speeds[i]});
    for (std::size_t p = 0; p < stops.size(); ++p)
      if (from[i][p] < auction::kImpossible)
        mission.map.paths.push_back(decision::certain_path(at(start), at(p), std::max(kRounding, from[i][p])));
  }
  return mission;
}

/// Eq. 10, for `team` robots of which `costs` knows all, or only the one that asks.
auction::Burden frontier_burden(TeamCosts& costs, std::size_t team) {
  return auction::altruistic([&costs](int i, const TaskSet& set) { return costs.cost(costs.robots() == 1 ? 0 : i, set); },
                             kNoc * costs.diameter(), static_cast<double>(costs.tasks()) / static_cast<double>(team));
}

/// One negotiation of D-SSA: everything that lives as long as it.
struct Talk {
  Talk(const Situation& s, const Awards& awards, const std::vector<BidEntry>& own) : round(awards.round), since_s(s.now_s) {
    std::vector<Award> sorted = awards.awards;
    std::sort(sorted.begin(), sorted.end(), [](const Award& a, const Award& b) {
      return std::pair(a.task.y, a.task.x) < std::pair(b.task.y, b.task.x);
    });
    RobotId last = s.self;
    for (const RobotId robot : awards.bidders) last = std::max(last, robot);
    std::vector<double> from;
    auction::Allocation initial(static_cast<std::size_t>(last) + 1);
    for (const Award& award : sorted) {
      initial[static_cast<std::size_t>(award.robot)].insert(static_cast<int>(stops.size()));
      stops.push_back({award.task, award.stand});
      const auto entry = std::find_if(own.begin(), own.end(), [&](const BidEntry& e) { return e.task == award.task; });
      from.push_back(entry == own.end() ? auction::kImpossible : static_cast<double>(entry->distance));
    }
    mission = frontier_mission(s, stops, {from}, {s.spec.speed});
    costs = std::make_unique<TeamCosts>(mission, false);
    problem = {last + 1, costs->tasks(), frontier_burden(*costs, awards.bidders.size()), kRounding};
    mind = std::make_unique<auction::HandOver>(problem, s.self, round, initial, auction::NegotiationTimes{.dead_s = kTalkTimeout},
                                               1, s.now_s);
    for (RobotId robot = 0; robot <= last; ++robot)
      if (std::find(awards.bidders.begin(), awards.bidders.end(), robot) == awards.bidders.end() && robot != s.self)
        mind->leave_out(robot);
  }

  RoundId round;
  double since_s;
  bool settled = false;
  std::vector<Stop> stops;
  decision::TopoMission mission;
  std::unique_ptr<TeamCosts> costs;
  auction::BundleProblem problem;
  std::unique_ptr<auction::HandOver> mind;
};

class BundleCoordinator : public Coordinator {
 public:
  BundleCoordinator(bool negotiate, const CoordinatorSettings& settings)
      : negotiate_(negotiate), grain_{.spacing = settings.cluster_spacing, .most = kMostTasks, .gains = false},
        rounds_(make_auction_coordinator([grain = grain_](const Situation&) { return grain; },
                                         [this](const auction::BidTable& table, const auction::Clear&) { return bundles(table); })) {}

  Decision decide(const Situation& s) override {
    situation_ = &s;
    Decision from_bundle = s.needs_task ? next_stop(s) : Decision{};
    Situation inner = s;
    inner.needs_task = s.needs_task && from_bundle.verdict == Decision::Verdict::kKeep;
    Decision decision = rounds_->decide(inner);
    for (const auto& delivery : s.inbox)
      if (const auto* awards = std::get_if<Awards>(delivery.message.get())) take(s, *awards);
    for (const Message& message : decision.send)
      if (const auto* awards = std::get_if<Awards>(&message)) take(s, *awards);
    if (decision.verdict == Decision::Verdict::kKeep && from_bundle.verdict != Decision::Verdict::kKeep) {
      decision.verdict = from_bundle.verdict;
      decision.task = from_bundle.task;
    }
    if (talk_) negotiate(s, decision);
    situation_ = nullptr;
    return decision;
  }

 private:
  /// The opener's part: SSA on the sheets, or who is nearest for a start.
  std::vector<Award> bundles(const auction::BidTable& table) {
    std::vector<Stop> stops;
    std::vector<std::vector<double>> from(table.robots(), std::vector<double>(table.tasks(), auction::kImpossible));
    std::vector<double> speeds;
    for (std::size_t p = 0; p < table.tasks(); ++p) {
      stops.push_back({table.task(p), table.task(p)});
      for (std::size_t i = 0; i < table.robots(); ++i)
        if (const BidEntry* entry = table.entry(i, p)) from[i][p] = entry->distance, stops[p].stand = entry->stand;
    }
    for (std::size_t i = 0; i < table.robots(); ++i) speeds.push_back(table.sheet(i).speed);
    if (stops.size() > static_cast<std::size_t>(TaskSet::kMost)) stops.resize(static_cast<std::size_t>(TaskSet::kMost));
    const decision::TopoMission mission = frontier_mission(*situation_, stops, from, speeds);
    TeamCosts costs(mission, false);
    const auction::BundleProblem problem{costs.robots(), costs.tasks(), frontier_burden(costs, table.robots()), kRounding};
    const auction::Allocation allocation =
        negotiate_ ? auction::nearest_allocation(problem) : auction::ssa(problem, auction::empty_allocation(problem)).allocation;
    std::vector<Award> awards;
    for (std::size_t i = 0; i < table.robots(); ++i)
      for (const int p : costs.order(static_cast<int>(i), allocation[i])) {
        const auto stop = static_cast<std::size_t>(p);
        if (table.entry(i, stop) != nullptr) awards.push_back(table.award(i, stop, -from[i][stop]));
        else awards.push_back({table.sheet(i).robot, stops[stop].task, stops[stop].stand, 0.0});  // near others it listed
      }
    return awards;
  }

  /// Our part of a round: the first task is on its way already, the others wait.
  void take(const Situation& s, const Awards& awards) {
    if (std::find(awards.bidders.begin(), awards.bidders.end(), s.self) == awards.bidders.end()) return;
    bundle_.clear();
    for (const Award& award : awards.awards)
      if (award.robot == s.self) bundle_.push_back({award.task, award.stand});
    if (!bundle_.empty()) bundle_.pop_front();
    talk_.reset();
    if (negotiate_ && awards.bidders.size() > 1 && !awards.awards.empty())
      talk_ = std::make_unique<Talk>(s, awards, s.tasks(grain_));
  }

  void negotiate(const Situation& s, Decision& decision) {
    for (const auto& delivery : s.inbox) talk_->mind->hear(*delivery.message, s.now_s);
    for (Message& message : talk_->mind->act(s.now_s)) decision.send.push_back(std::move(message));
    const bool over = talk_->mind->done() || s.now_s > talk_->since_s + kTalkTimeout;
    if (over && !talk_->settled) {
      talk_->settled = true;
      bundle_.clear();
      for (const int p : talk_->costs->order(0, talk_->mind->tasks())) bundle_.push_back(talk_->stops[static_cast<std::size_t>(p)]);
      decision.verdict = Decision::Verdict::kIdle;
      decision.task.reset();
      if (!bundle_.empty()) {
        decision.verdict = Decision::Verdict::kGo;
        decision.task = Task{bundle_.front().task, bundle_.front().stand};
        bundle_.pop_front();
      }
    }
    if (s.now_s > talk_->since_s + 2.0 * kTalkTimeout) talk_.reset();  // others may have needed us until now
  }

  /// The next task of the bundle that is still there: frontiers move while the map grows.
  Decision next_stop(const Situation& s) {
    if (bundle_.empty()) return {};
    const std::vector<BidEntry> entries = s.tasks(grain_);
    while (!bundle_.empty()) {
      const Point wanted = s.map.geometry().center(bundle_.front().task);
      bundle_.pop_front();
      const BidEntry* nearest = nullptr;
      double least = grain_.spacing;
      for (const BidEntry& e : entries)
        if (const double d = distance(s.map.geometry().center(e.task), wanted); d < least) least = d, nearest = &e;
      if (nearest != nullptr)
        return {.verdict = Decision::Verdict::kGo, .task = Task{nearest->task, nearest->stand},
                .value = -static_cast<double>(nearest->distance)};
    }
    return {};
  }

  bool negotiate_;
  TaskGrain grain_;
  std::unique_ptr<Coordinator> rounds_;
  const Situation* situation_ = nullptr;  // of the decision being made
  std::deque<Stop> bundle_;
  std::unique_ptr<Talk> talk_;
};

}  // namespace

std::unique_ptr<Coordinator> make_bundle_coordinator(std::string_view name, const CoordinatorSettings& settings) {
  if (name == "continuous")
    return make_auction_coordinator([spacing = settings.cluster_spacing](const Situation&) {
                                      return TaskGrain{.spacing = spacing, .most = 256, .gains = false};
                                    },
                                    [](const auction::BidTable& table, const auction::Clear&) { return continuous_awards(table); });
  return std::make_unique<BundleCoordinator>(name == "dssa", settings);
}

}  // namespace outrider::explorer
