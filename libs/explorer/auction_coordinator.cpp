#include "explorer/auction_coordinator.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "explorer/open_round.hpp"
#include "world/ray.hpp"

namespace outrider::explorer {
namespace {

constexpr double kSheetTimeout = 1.0;   // [s] that a seller waits for sheets
constexpr double kCallAgain = 0.3;      // [s] between its calls
constexpr double kAwardTimeout = 2.0;   // [s] that a bidder waits for awards
constexpr double kAwardsAgain = 0.6;    // [s] between two broadcasts of awards; more than a status period
constexpr double kRetry = 1.0;          // [s] between rounds opened by a robot that went away empty-handed
constexpr int kMostPatient = 4;         // times that such a robot of a large team waits twice as long as before
constexpr double kStagger = 0.25;       // [s] between the robots that could sell a silent one's task
constexpr double kLetGo = 0.8;          // [s] that a robot shares a frontier before it gives way: a round and some

bool holds(const std::vector<RobotId>& robots, RobotId robot) {
  return std::find(robots.begin(), robots.end(), robot) != robots.end();
}

class AuctionCoordinator : public Coordinator {
 public:
  AuctionCoordinator(BidFor bid_for, Allocate allocate, auction::Rebid rebid)
      : bid_for_(std::move(bid_for)), allocate_(std::move(allocate)), rebid_(rebid) {}

  Decision decide(const Situation& s) override {
    Decision decision;
    for (const Teammate& mate : s.known) newest_ = std::max(newest_, mate.status.epoch.count);
    for (const auto& delivery : s.inbox) {
      const Message& message = *delivery.message;
      if (const auto* open = std::get_if<RoundOpen>(&message)) answer(s, *open, decision);
      if (const auto* sheet = std::get_if<BidSheet>(&message); sheet != nullptr && open_) open_->collect(*sheet);
      if (const auto* awards = std::get_if<Awards>(&message)) obey(s, *awards, decision);
    }
    if (answered_ && s.now_s > answered_->since_s + kAwardTimeout) answered_.reset();
    const bool contested = is_contested(s), lapsed = has_lapsed(s);
    const bool keeps = decision.verdict == Decision::Verdict::kKeep, free = keeps && !open_ && !answered_;
    if (contested && keeps && s.now_s > shared_since_s_ + kLetGo) return let_go(s, std::move(decision));
    if (free && (contested || lapsed || (s.needs_task && s.now_s >= retry_at_s_))) open_round(s, decision);
    if (open_ && (open_->complete() || s.now_s > open_->since_s + kSheetTimeout)) close_round(s, decision);
    repeat(s, decision);
    return decision;
  }

 private:
  /// A round that this robot has bid in and whose outcome it waits for.
  struct Answered {
    RoundId round;
    double since_s;
    double sent_s;
    std::vector<BidSheet> parts;
  };
  /// Awards that this robot has made and that somebody may not know of yet.
  struct Standing {
    std::vector<Awards> messages;
    double until_s;
    double again_s;
  };

  BidSheet own_sheet(const Situation& s, RoundId round) const {
    return {round, s.self, s.pose, s.spec.speed, s.spec.range, s.explored_rate,
            s.task.has_value() && !s.needs_task, s.task ? std::optional(s.task->cell) : std::nullopt, s.tasks(bid_for_(s)), newest_};
  }

  void open_round(const Situation& s, Decision& decision) {
    const RoundId id{s.self, ++count_};
    BidSheet own = own_sheet(s, id);
    if (own.entries.empty()) {  // nothing to sell; team-mates that know more open their own rounds
      if (s.needs_task) decision.verdict = Decision::Verdict::kNothing;
      return;
    }
    open_ = OpenRound{id, s.now_s, s.now_s + kCallAgain, nearest(s), s.team.size() > kMostAsked, {}, {}};
    open_->sheets.push_back(std::move(own));
    decision.send.emplace_back(open_->call());
  }

  /// The team-mates in hearing, of a large team the nearest, ascending.
  static std::vector<RobotId> nearest(const Situation& s) {
    std::vector<std::pair<double, RobotId>> mates;
    for (const Teammate& mate : s.team)
      mates.emplace_back(distance(mate.status.pose.position(), s.pose.position()), mate.robot);
    if (mates.size() > kMostAsked) {
      std::partial_sort(mates.begin(), mates.begin() + kMostAsked, mates.end());
      mates.resize(kMostAsked);
    }
    std::vector<RobotId> robots;
    for (const auto& [apart, robot] : mates) robots.push_back(robot);
    std::sort(robots.begin(), robots.end());
    return robots;
  }

  void answer(const Situation& s, const RoundOpen& open, Decision& decision) {
    if (!open.asked.empty() && !holds(open.asked, s.self)) return;
    if (open_ && open_->id.opener < open.round.opener) return;  // ours stands; its opener will answer us
    if (const auto closed = closed_.find(open.round.opener); closed != closed_.end() && closed->second == open.round.count) return;
    if (!answered_ || answered_->round != open.round) {
      open_.reset();
      answered_ = Answered{open.round, s.now_s, -1e9, cut(own_sheet(s, open.round))};
    }
    if (holds(open.heard, s.self) || s.now_s < answered_->sent_s + kCallAgain / 2.0) return;
    answered_->sent_s = s.now_s;
    for (const BidSheet& part : answered_->parts) decision.send.emplace_back(part);
  }

  void close_round(const Situation& s, Decision& decision) {
    std::vector<BidSheet> sheets = std::move(open_->sheets);
    Awards awards{open_->id, newest_, {}, {}};
    AuctionRecord record{s.now_s, open_->id, {}, {}, {}};
    std::vector<RobotId> heard;
    for (const BidSheet& sheet : sheets) {
      heard.push_back(sheet.robot);
      if (!sheet.busy || rebid_ == auction::Rebid::kEverybody) awards.bidders.push_back(sheet.robot);
      awards.epoch = std::max(awards.epoch, sheet.epoch);
    }
    ++awards.epoch;  // newer than whatever any bidder follows
    std::sort(awards.bidders.begin(), awards.bidders.end());
    for (const RobotId robot : open_->expected)
      if (!holds(heard, robot)) record.unheard.push_back(robot);
    open_.reset();
    withdraw_leased(s, heard, sheets);
    const auto& g = s.map.geometry();
    const auto clear = [&](Point a, Point b) { return line_of_sight(s.map, g.cell_of(a), g.cell_of(b)); };
    awards.awards = allocate_(auction::BidTable(sheets, g), clear);
    record.sheets = std::move(sheets);
    record.awards = awards.awards;
    decision.records.push_back(std::move(record));
    standing_ = Standing{cut(awards), s.now_s + kLease, s.now_s + kAwardsAgain};
    for (const Awards& message : standing_->messages) {
      obey(s, message, decision);
      decision.send.emplace_back(message);
    }
  }

  /// What somebody holds who does not bid is not for sale.
  void withdraw_leased(const Situation& s, const std::vector<RobotId>& bidders, std::vector<BidSheet>& sheets) const {
    for (const Teammate& mate : s.known) {
      if (!mate.status.goal || holds(bidders, mate.robot) || s.now_s > mate.heard_s + kLease) continue;
      for (BidSheet& sheet : sheets)
        std::erase_if(sheet.entries, [&](const BidEntry& entry) { return same_frontier(s, entry.task, *mate.status.goal); });
    }
  }

  void obey(const Situation& s, const Awards& awards, Decision& decision) {
    closed_[awards.round.opener] = awards.round.count;
    if (answered_ && answered_->round == awards.round) answered_.reset();
    newest_ = std::max(newest_, awards.epoch);
    awarded_s_ = s.now_s;
    const Epoch epoch{awards.epoch, awards.round.opener};
    if (!epoch.newer_than(epoch_) || !holds(awards.bidders, s.self)) return;
    epoch_ = epoch;
    decision.epoch = epoch;
    const auto mine = std::find_if(awards.awards.begin(), awards.awards.end(),
                                   [&](const Award& award) { return award.robot == s.self; });
    if (mine == awards.awards.end()) {
      decision.verdict = Decision::Verdict::kIdle;
      decision.task.reset();
      empty_handed_ = s.team.size() > kMostAsked ? std::min(empty_handed_ + 1, kMostPatient) : 0;
      retry_at_s_ = s.now_s + std::ldexp(kRetry, empty_handed_);
      return;
    }
    empty_handed_ = 0;
    decision.verdict = Decision::Verdict::kGo;
    decision.task = Task{mine->task, mine->stand};
    decision.value = mine->value;
  }

  /// Robots with different maps name the same stretch of frontier by neighbouring cells.
  bool same_frontier(const Situation& s, Cell a, Cell b) const {
    const int reach = static_cast<int>(bid_for_(s).spacing / 2.0 / s.map.geometry().resolution);
    return std::abs(a.x - b.x) <= reach && std::abs(a.y - b.y) <= reach;
  }

  /// Somebody in hearing drives to this robot's frontier under a newer award.
  bool is_contested(const Situation& s) {
    bool shared = false, contested = false;
    for (const Teammate& mate : s.team) {
      if (!s.task || !mate.status.goal || mate.status.epoch == epoch_) continue;
      if (!same_frontier(s, s.task->cell, *mate.status.goal)) continue;
      shared = true;
      contested = contested || mate.status.epoch.newer_than(epoch_);
    }
    if (!shared) shared_since_s_ = s.now_s;
    return contested;
  }

  Decision let_go(const Situation& s, Decision decision) {
    decision.verdict = Decision::Verdict::kIdle;
    decision.task.reset();
    open_.reset();
    shared_since_s_ = s.now_s;
    return decision;
  }

  /// A silent robot's lease has ended, nobody has sold anything since, and it is this robot's turn to do so.
  bool has_lapsed(const Situation& s) {
    const auto rank = std::count_if(s.team.begin(), s.team.end(), [&](const Teammate& m) { return m.robot < s.self; });
    bool lapsed = false;
    for (const Teammate& mate : s.known) {
      const double end_s = mate.heard_s + kLease;
      if (!mate.status.goal || s.now_s <= end_s + kStagger * static_cast<double>(rank)) continue;
      const auto [sold, first] = sold_.try_emplace(mate.robot, -1e9);
      if (sold->second >= mate.heard_s) continue;
      sold->second = mate.heard_s;
      lapsed = lapsed || (awarded_s_ <= end_s && !s.team.empty());
    }
    return lapsed;
  }

  void repeat(const Situation& s, Decision& decision) {
    if (open_ && s.now_s >= open_->repeat_s) {
      open_->repeat_s = s.now_s + kCallAgain;
      decision.send.emplace_back(open_->call());
    }
    if (!standing_ || s.now_s < standing_->again_s) return;
    standing_->again_s = s.now_s + kAwardsAgain;
    bool open = false;
    for (const Awards& message : standing_->messages) {
      const Epoch epoch{message.epoch, message.round.opener};
      const bool unknown = newest_ == message.epoch && std::any_of(s.team.begin(), s.team.end(), [&](const Teammate& m) {
        return holds(message.bidders, m.robot) && epoch.newer_than(m.status.epoch);
      });
      if (unknown) decision.send.emplace_back(message);
      open = open || unknown;
    }
    if (!open || s.now_s > standing_->until_s) standing_.reset();
  }

  BidFor bid_for_;
  Allocate allocate_;
  auction::Rebid rebid_;
  std::uint32_t count_ = 0;                  // of the rounds opened
  std::uint32_t newest_ = 0;                 // greatest epoch heard of
  Epoch epoch_;                              // of the award that is followed
  std::optional<OpenRound> open_;
  std::optional<Answered> answered_;
  std::optional<Standing> standing_;
  std::map<RobotId, std::uint32_t> closed_;  // each robot's last round with awards
  std::map<RobotId, double> sold_;           // when the silent, whose tasks are sold again, were last heard [s]
  double awarded_s_ = -1e9;                  // when awards last came in
  double shared_since_s_ = 0.0;              // a team-mate has this robot's frontier since [s]
  double retry_at_s_ = 0.0;
  int empty_handed_ = 0;                     // rounds in a row without an award
};

}  // namespace

std::unique_ptr<Coordinator> make_auction_coordinator(BidFor bid_for, Allocate allocate, auction::Rebid rebid) {
  return std::make_unique<AuctionCoordinator>(std::move(bid_for), std::move(allocate), rebid);
}

}  // namespace outrider::explorer
