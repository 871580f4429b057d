#include "explorer/auction_coordinator.hpp"

#include <algorithm>
#include <optional>

#include "world/ray.hpp"

namespace outrider::explorer {
namespace {

constexpr double kSheetTimeout = 0.5;  // [s] that an opener waits for sheets
constexpr double kAwardTimeout = 1.0;  // [s] that a bidder waits for awards
constexpr double kRetry = 1.0;         // [s] between rounds opened by a robot that went away empty-handed

class AuctionCoordinator : public Coordinator {
 public:
  AuctionCoordinator(BidFor bid_for, Allocate allocate, auction::Rebid rebid)
      : bid_for_(std::move(bid_for)), allocate_(std::move(allocate)), rebid_(rebid) {}

  Decision decide(const Situation& s) override {
    Decision decision;
    for (const auto& delivery : s.inbox) {
      const Message& message = *delivery.message;
      if (const auto* open = std::get_if<RoundOpen>(&message)) answer(s, *open, decision);
      if (const auto* sheet = std::get_if<BidSheet>(&message)) collect(*sheet);
      if (const auto* awards = std::get_if<Awards>(&message)) obey(s, *awards, decision);
    }
    if (awaiting_ && s.now_s > awaiting_->second + kAwardTimeout) awaiting_.reset();
    if (s.needs_task && !open_ && !awaiting_ && s.now_s >= retry_at_s_ && decision.verdict == Decision::Verdict::kKeep)
      open_round(s, decision);
    if (open_ && (complete() || s.now_s > open_->since_s + kSheetTimeout)) close_round(s, decision);
    return decision;
  }

 private:
  struct OpenRound {
    RoundId id;
    double since_s;
    std::vector<RobotId> expected;
    std::vector<BidSheet> sheets;
  };

  BidSheet own_sheet(const Situation& s, RoundId round) const {
    return {round, s.self, s.pose, s.spec.speed, s.spec.range, s.explored_rate,
            s.task.has_value() && !s.needs_task, s.task ? std::optional(s.task->cell) : std::nullopt, s.tasks(bid_for_(s))};
  }

  void open_round(const Situation& s, Decision& decision) {
    const RoundId id{s.self, ++count_};
    BidSheet own = own_sheet(s, id);
    if (own.entries.empty()) {  // nothing to sell; team-mates that know more open their own rounds
      decision.verdict = Decision::Verdict::kNothing;
      return;
    }
    open_ = OpenRound{id, s.now_s, {}, {}};
    for (const Teammate& mate : s.team) open_->expected.push_back(mate.robot);
    open_->sheets.push_back(std::move(own));
    decision.send.emplace_back(RoundOpen{id});
  }

  void answer(const Situation& s, const RoundOpen& open, Decision& decision) {
    if (open_ && open_->id.opener < open.round.opener) return;  // ours stands; its opener will answer us
    open_.reset();
    awaiting_ = {open.round, s.now_s};
    decision.send.emplace_back(own_sheet(s, open.round));
  }

  void collect(const BidSheet& sheet) {
    if (!open_ || sheet.round != open_->id) return;
    const bool known = std::any_of(open_->sheets.begin(), open_->sheets.end(),
                                   [&](const BidSheet& other) { return other.robot == sheet.robot; });
    if (!known) open_->sheets.push_back(sheet);
  }

  bool complete() const {
    return std::all_of(open_->expected.begin(), open_->expected.end(), [&](RobotId robot) {
      return std::any_of(open_->sheets.begin(), open_->sheets.end(), [&](const auto& s) { return s.robot == robot; });
    });
  }

  void close_round(const Situation& s, Decision& decision) {
    const auction::BidTable bids(open_->sheets, s.map.geometry());
    const auto& g = s.map.geometry();
    const auto clear = [&](Point a, Point b) { return line_of_sight(s.map, g.cell_of(a), g.cell_of(b)); };
    Awards awards{open_->id, {}, allocate_(bids, clear)};
    for (std::size_t i = 0; i < bids.robots(); ++i)
      if (!bids.sheet(i).busy || rebid_ == auction::Rebid::kEverybody) awards.bidders.push_back(bids.sheet(i).robot);
    AuctionRecord record{s.now_s, open_->id, std::move(open_->sheets), awards.awards, {}};
    for (const RobotId robot : open_->expected)
      if (std::none_of(record.sheets.begin(), record.sheets.end(), [&](const auto& sheet) { return sheet.robot == robot; }))
        record.unheard.push_back(robot);
    decision.records.push_back(std::move(record));
    open_.reset();
    obey(s, awards, decision);
    decision.send.emplace_back(std::move(awards));
  }

  void obey(const Situation& s, const Awards& awards, Decision& decision) {
    if (awaiting_ && awaiting_->first == awards.round) awaiting_.reset();
    if (std::find(awards.bidders.begin(), awards.bidders.end(), s.self) == awards.bidders.end()) return;
    const auto mine = std::find_if(awards.awards.begin(), awards.awards.end(),
                                   [&](const Award& award) { return award.robot == s.self; });
    if (mine == awards.awards.end()) {
      decision.verdict = Decision::Verdict::kIdle;
      decision.task.reset();
      retry_at_s_ = s.now_s + kRetry;
      return;
    }
    decision.verdict = Decision::Verdict::kGo;
    decision.task = Task{mine->task, mine->stand};
    decision.value = mine->value;
  }

  BidFor bid_for_;
  Allocate allocate_;
  auction::Rebid rebid_;
  std::uint32_t count_ = 0;
  std::optional<OpenRound> open_;
  std::optional<std::pair<RoundId, double>> awaiting_;  // a round we bid in, and since when [s]
  double retry_at_s_ = 0.0;
};

}  // namespace

std::unique_ptr<Coordinator> make_auction_coordinator(BidFor bid_for, Allocate allocate, auction::Rebid rebid) {
  return std::make_unique<AuctionCoordinator>(std::move(bid_for), std::move(allocate), rebid);
}

}  // namespace outrider::explorer
