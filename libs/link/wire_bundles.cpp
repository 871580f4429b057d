// The messages of auctions of task bundles (Lozenguez 2015).

#include "link/wire.hpp"
#include "link/wire_numbers.hpp"

namespace outrider::link {
namespace {

using namespace outrider_wire;

bool owner(std::int16_t robot) { return robot >= Claim::kNobody; }
bool cost(double value) { return !std::isnan(value); }  // infinity: cannot be done

}  // namespace

claim_sheet_t to_wire(const ClaimSheet& m) {
  claim_sheet_t w{};
  w.opener = i16(m.round.opener);
  w.count = i32(m.round.count);
  w.seq = i32(m.seq);
  w.first = i32(m.first);
  w.hash = std::bit_cast<std::int64_t>(m.hash);
  w.content = m.content;
  w.done = m.done;
  w.n_claims = i16(m.claims.size());
  w.n_prices = i16(m.prices.size());
  w.claims = each<claim_t>(m.claims, [](const Claim& claim) {
    claim_t c{};
    c.epoch = i32(claim.epoch);
    c.owner = i16(claim.owner);
    return c;
  });
  w.prices = m.prices;
  return w;
}

std::optional<Message> from_wire(const claim_sheet_t& w, RobotId sender) {
  if (w.opener < 0 || w.first < 0 || !truth(w.content) || !truth(w.done) || w.n_claims != w.n_prices) return {};
  if (!all(w.claims, [](const claim_t& c) { return owner(c.owner); }) || !all(w.prices, cost)) return {};
  ClaimSheet m{{w.opener, u32(w.count)}, sender, u32(w.seq), u32(w.first), {}, w.prices};
  m.claims = each<Claim>(w.claims, [](const claim_t& c) { return Claim{u32(c.epoch), c.owner}; });
  m.hash = std::bit_cast<std::uint64_t>(w.hash);
  m.content = w.content == 1;
  m.done = w.done == 1;
  return m;
}

task_offer_t to_wire(const TaskOffer& m) {
  task_offer_t w{};
  w.opener = i16(m.round.opener);
  w.count = i32(m.round.count);
  w.to = i16(m.to);
  w.serial = i32(m.serial);
  w.task = i32(m.task);
  w.epoch = i32(m.epoch);
  w.price = m.price;
  return w;
}

std::optional<Message> from_wire(const task_offer_t& w, RobotId sender) {
  if (w.opener < 0 || w.to < 0 || w.task < 0 || !cost(w.price)) return {};
  return TaskOffer{{w.opener, u32(w.count)}, sender, w.to, u32(w.serial), u32(w.task), u32(w.epoch), w.price};
}

task_answer_t to_wire(const TaskAnswer& m) {
  task_answer_t w{};
  w.opener = i16(m.round.opener);
  w.count = i32(m.round.count);
  w.to = i16(m.to);
  w.serial = i32(m.serial);
  w.verdict = static_cast<std::uint8_t>(m.verdict);
  return w;
}

std::optional<Message> from_wire(const task_answer_t& w, RobotId sender) {
  if (w.opener < 0 || w.to < 0 || w.verdict > static_cast<std::uint8_t>(TaskAnswer::Verdict::kBusy)) return {};
  return TaskAnswer{{w.opener, u32(w.count)}, sender, w.to, u32(w.serial), static_cast<TaskAnswer::Verdict>(w.verdict)};
}

plan_sheet_t to_wire(const PlanSheet& m) {
  plan_sheet_t w{};
  w.opener = i16(m.round.opener);
  w.count = i32(m.round.count);
  w.seq = i32(m.seq);
  w.makespan = m.makespan;
  w.total = m.total;
  w.without = std::bit_cast<std::int64_t>(m.without);
  w.searched = m.searched;
  w.n_owners = i16(m.owners.size());
  w.owners = robots(m.owners);
  return w;
}

std::optional<Message> from_wire(const plan_sheet_t& w, RobotId sender) {
  if (w.opener < 0 || !cost(w.makespan) || !cost(w.total) || !truth(w.searched) || !all(w.owners, owner)) return {};
  PlanSheet m{{w.opener, u32(w.count)}, sender, u32(w.seq), w.makespan, w.total, {w.owners.begin(), w.owners.end()}};
  m.without = std::bit_cast<std::uint64_t>(w.without);
  m.searched = w.searched == 1;
  return m;
}

}  // namespace outrider::link
