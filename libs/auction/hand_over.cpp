#include "auction/hand_over.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace outrider::auction {
namespace {

/// True when `a` holds against `b`.
bool outranks(const Claim& a, const Claim& b) {
  if (a.epoch != b.epoch) return a.epoch > b.epoch;
  return a.owner != b.owner && a.owner != Claim::kNobody && (b.owner == Claim::kNobody || a.owner < b.owner);
}

}  // namespace

HandOver::HandOver(const BundleProblem& problem, RobotId self, RoundId round, const Allocation& initial,
                   const NegotiationTimes& times, std::uint64_t seed, double now_s)
    : problem_(problem), self_(self), round_(round), times_(times),
      random_(seed * 0x9E3779B97F4A7C15U + static_cast<std::uint64_t>(self)),
      claims_(static_cast<std::size_t>(problem.tasks)), prices_(claims_.size()), mine_(initial[static_cast<std::size_t>(self)]),
      peers_(static_cast<std::size_t>(problem.robots)), said_s_(-times.repeat_s) {
  const std::size_t stretches = std::max<std::size_t>(1, (claims_.size() + ClaimSheet::kMostClaims - 1) / ClaimSheet::kMostClaims);
  for (Peer& peer : peers_) {
    peer.heard_s = now_s;
    peer.seq.assign(stretches, 0);
    peer.hash.assign(stretches, 0);
    peer.prices.assign(claims_.size(), kImpossible);
  }
  for (std::size_t i = 0; i < initial.size(); ++i)
    initial[i].for_each([&](int g) { claims_[static_cast<std::size_t>(g)].owner = static_cast<RobotId>(i); });
}

void HandOver::hear(const Message& message, double now_s) {
  const auto known = [&](RoundId round, RobotId robot) {
    if (round != round_ || robot < 0 || robot >= problem_.robots || robot == self_) return false;
    Peer& peer = peers_[static_cast<std::size_t>(robot)];
    peer.heard_s = now_s;
    peer.dead = false;
    return true;
  };
  if (const auto* sheet = std::get_if<ClaimSheet>(&message); sheet && known(sheet->round, sheet->robot)) hear_sheet(*sheet);
  if (const auto* offer = std::get_if<TaskOffer>(&message);
      offer && known(offer->round, offer->robot) && offer->to == self_ && offer->task < claims_.size())
    hear_offer(*offer);
  if (const auto* answer = std::get_if<TaskAnswer>(&message);
      answer && known(answer->round, answer->robot) && answer->to == self_)
    hear_answer(*answer, now_s);
}

void HandOver::hear_sheet(const ClaimSheet& sheet) {
  const std::size_t stretch = sheet.first / ClaimSheet::kMostClaims;
  if (sheet.first % ClaimSheet::kMostClaims != 0 || sheet.first + sheet.claims.size() > claims_.size() ||
      sheet.prices.size() != sheet.claims.size() || sheet.claims.empty() != claims_.empty())
    return;
  Peer& peer = peers_[static_cast<std::size_t>(sheet.robot)];
  for (std::size_t k = 0; k < sheet.claims.size(); ++k) merge(sheet.first + k, sheet.claims[k]);  // old ones do no harm
  if (sheet.seq <= peer.seq[stretch]) return;
  peer.seq[stretch] = sheet.seq;
  peer.hash[stretch] = sheet.hash;
  std::copy(sheet.prices.begin(), sheet.prices.end(), peer.prices.begin() + sheet.first);
  peer.content = sheet.content;
  peer.done = sheet.done;
}

void HandOver::hear_offer(const TaskOffer& offer) {
  Peer& peer = peers_[static_cast<std::size_t>(offer.robot)];
  if (offer.serial < peer.answered) return;  // long settled
  if (offer.serial > peer.answered) {
    peer.answered = offer.serial;
    const Claim& known = claims_[offer.task];
    const bool stale = known.epoch > offer.epoch || mine_.contains(static_cast<int>(offer.task));
    const double now = stale ? kImpossible : price(problem_, self_, mine_, static_cast<int>(offer.task));
    if (pending_) peer.verdict = TaskAnswer::Verdict::kBusy;
    else if (now < offer.price - problem_.epsilon) peer.verdict = TaskAnswer::Verdict::kAccepted;
    else peer.verdict = TaskAnswer::Verdict::kDeclined;
    if (peer.verdict == TaskAnswer::Verdict::kAccepted) set_claim(offer.task, {offer.epoch + 1, self_});
  }
  out_.emplace_back(TaskAnswer{round_, self_, offer.robot, offer.serial, peer.verdict});
  if (peer.verdict != TaskAnswer::Verdict::kBusy) news_ = true;  // with what it costs me now
}

void HandOver::hear_answer(const TaskAnswer& answer, double now_s) {
  if (!pending_ || answer.serial != pending_->offer.serial || answer.robot != pending_->offer.to) return;
  const TaskOffer offer = pending_->offer;
  pending_.reset();
  switch (answer.verdict) {
    case TaskAnswer::Verdict::kAccepted:
      merge(offer.task, {offer.epoch + 1, answer.robot});
      break;
    case TaskAnswer::Verdict::kDeclined:
      peers_[static_cast<std::size_t>(answer.robot)].declined_at = peers_[static_cast<std::size_t>(answer.robot)].seq[0];
      break;
    case TaskAnswer::Verdict::kBusy: {
      const double unit = static_cast<double>(random_() >> 11U) * 0x1p-53;
      wait_until_s_ = now_s + times_.back_off_s * (0.5 + unit);
      break;
    }
  }
}

void HandOver::merge(std::size_t task, const Claim& claim) {
  if (outranks(claim, claims_[task])) set_claim(task, claim);
}

void HandOver::set_claim(std::size_t task, const Claim& claim) {
  const bool was_mine = claims_[task].owner == self_, is_mine = claim.owner == self_;
  claims_[task] = claim;
  if (was_mine != is_mine) ++modifications_;
  if (is_mine) mine_.insert(static_cast<int>(task));
  else mine_.erase(static_cast<int>(task));
  if (pending_ && pending_->offer.task == task) pending_.reset();  // it has its new owner, told by a sheet
  changed_ = true;
}

/// Whoever is silent for too long is dead. What was on offer to it is withdrawn by a new epoch: should it live and have
/// accepted, it will hear that it has lost the task.
void HandOver::bury(double now_s) {
  for (std::size_t i = 0; i < peers_.size(); ++i)
    if (static_cast<RobotId>(i) != self_ && !peers_[i].dead && now_s > peers_[i].heard_s + times_.dead_s) peers_[i].dead = true;
  if (!pending_ || !dead(pending_->offer.to)) return;
  const TaskOffer offer = pending_->offer;
  pending_.reset();
  set_claim(offer.task, {offer.epoch + 2, self_});
}

bool HandOver::heard_all() const {
  for (std::size_t i = 0; i < peers_.size(); ++i)
    if (static_cast<RobotId>(i) != self_ && !peers_[i].dead &&
        std::find(peers_[i].seq.begin(), peers_[i].seq.end(), 0U) != peers_[i].seq.end())
      return false;
  return true;
}

bool HandOver::free(std::size_t task) const {
  const RobotId owner = claims_[task].owner;
  return owner == Claim::kNobody || (owner != self_ && dead(owner));
}

/// Takes the free task for which this robot is the best bidder, of several the one that costs least. True when it did,
/// or when there is a free task that somebody should take.
bool HandOver::claim_one() {
  std::size_t best = claims_.size();
  bool left = false;
  for (std::size_t g = 0; g < claims_.size(); ++g) {
    if (!free(g)) continue;
    double least = prices_[g];
    RobotId bidder = self_;
    for (std::size_t i = 0; i < peers_.size(); ++i)
      if (const auto robot = static_cast<RobotId>(i); robot != self_ && !peers_[i].dead &&
          (peers_[i].prices[g] < least || (peers_[i].prices[g] == least && robot < bidder)))
        least = peers_[i].prices[g], bidder = robot;
    if (least == kImpossible) continue;
    left = true;
    if (bidder == self_ && (best == claims_.size() || prices_[g] < prices_[best])) best = g;
  }
  if (best < claims_.size()) set_claim(best, {claims_[best].epoch + 1, self_});
  return left;
}

/// Offers the task that somebody else could do with the greatest gain. True when there is such a task.
bool HandOver::offer_one(double now_s) {
  double most = problem_.epsilon;
  int task = -1;
  RobotId to = self_;
  bool declined = false;
  mine_.for_each([&](int g) {
    for (std::size_t i = 0; i < peers_.size(); ++i) {
      const Peer& peer = peers_[i];
      if (static_cast<RobotId>(i) == self_ || peer.dead) continue;
      const double gain = prices_[static_cast<std::size_t>(g)] - peer.prices[static_cast<std::size_t>(g)];
      if (!(gain > problem_.epsilon)) continue;
      if (peer.declined_at != 0 && peer.seq[0] <= peer.declined_at) declined = true;
      else if (gain > most) most = gain, task = g, to = static_cast<RobotId>(i);
    }
  });
  if (task < 0) return declined;
  if (now_s < wait_until_s_) return true;
  const auto g = static_cast<std::size_t>(task);
  const TaskOffer offer{round_, self_, to, ++serial_, static_cast<std::uint32_t>(task), claims_[g].epoch, prices_[g]};
  pending_ = {offer, now_s};
  out_.emplace_back(offer);
  return true;
}

/// Everybody computed with the same claims: nobody has anything to gain, and by then nothing is under way.
void HandOver::judge() {
  bool same = true, all_content = true;
  for (std::size_t i = 0; i < peers_.size(); ++i) {
    if (static_cast<RobotId>(i) == self_ || peers_[i].dead) continue;
    same = same && std::all_of(peers_[i].hash.begin(), peers_[i].hash.end(), [&](auto h) { return h == hash_; });
    all_content = all_content && peers_[i].content;
  }
  const bool content = same && !pending_;
  const bool done = content && all_content;
  if (content != content_ || done != done_) news_ = true;
  content_ = content;
  done_ = done;
}

void HandOver::compute_prices() {
  if (!priced_ || *priced_ != mine_)
    for (std::size_t g = 0; g < claims_.size(); ++g) prices_[g] = price(problem_, self_, mine_, static_cast<int>(g));
  priced_ = mine_;
  hash_ = claims_hash();
  changed_ = false;
  news_ = true;
}

std::uint64_t HandOver::claims_hash() const {
  std::uint64_t h = 0xCBF29CE484222325U;  // FNV-1a
  for (const Claim& c : claims_)
    for (const std::uint64_t part : {static_cast<std::uint64_t>(c.epoch), static_cast<std::uint64_t>(c.owner + 1)})
      h = (h ^ part) * 0x100000001B3U;
  return h;
}

void HandOver::append_sheets(double now_s) {
  ++seq_;
  std::size_t first = 0;
  do {
    const auto begin = static_cast<std::ptrdiff_t>(first);
    const auto end = static_cast<std::ptrdiff_t>(std::min(claims_.size(), first + ClaimSheet::kMostClaims));
    out_.emplace_back(ClaimSheet{round_, self_, seq_, static_cast<std::uint32_t>(first),
                                 {claims_.begin() + begin, claims_.begin() + end},
                                 {prices_.begin() + begin, prices_.begin() + end}, hash_, content_, done_});
    first += ClaimSheet::kMostClaims;
  } while (first < claims_.size());
  said_s_ = now_s;
  news_ = false;
}

std::vector<Message> HandOver::act(double now_s) {
  bury(now_s);
  if (changed_) compute_prices();
  bool busy = pending_.has_value();
  if (pending_ && now_s > pending_->sent_s + times_.repeat_s) {
    out_.emplace_back(pending_->offer);
    pending_->sent_s = now_s;
  }
  if (!busy && heard_all()) busy = claim_one() || offer_one(now_s);
  if (changed_) compute_prices();
  if (busy) {
    if (content_ || done_) news_ = true;
    content_ = done_ = false;
  } else {
    judge();
  }
  if (news_ || now_s >= said_s_ + times_.repeat_s) append_sheets(now_s);
  return std::exchange(out_, {});
}

}  // namespace outrider::auction
