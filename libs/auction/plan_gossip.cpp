#include "auction/plan_gossip.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace outrider::auction {

PlanGossip::PlanGossip(const BundleProblem& problem, RobotId self, RoundId round, const NegotiationTimes& times,
                       std::uint64_t seed, int starts, double now_s)
    : problem_(problem), self_(self), round_(round), times_(times), seed_(seed), starts_(starts),
      peers_(static_cast<std::size_t>(problem.robots)) {
  assert(problem.robots <= kMostRobots);
  for (Peer& peer : peers_) peer.heard_s = now_s;
  restart();
}

void PlanGossip::restart() {
  std::vector<char> able;
  int rank = 0;
  stride_ = 0;
  for (std::size_t i = 0; i < peers_.size(); ++i) {
    able.push_back(peers_[i].dead ? 0 : 1);
    if (!peers_[i].dead && static_cast<RobotId>(i) < self_) ++rank;
    stride_ += able.back();
  }
  search_.emplace(problem_, seed_, std::move(able));
  searched_without_ = without();
  next_start_ = rank;
  best_.reset();
  news_ = true;
}

std::uint64_t PlanGossip::without() const {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < peers_.size(); ++i)
    if (peers_[i].dead) bits |= std::uint64_t{1} << i;
  return bits;
}

void PlanGossip::hear(const Message& message, double now_s) {
  const auto* sheet = std::get_if<PlanSheet>(&message);
  if (sheet == nullptr || sheet->round != round_ || sheet->robot < 0 || sheet->robot >= problem_.robots ||
      sheet->robot == self_ || sheet->owners.size() != static_cast<std::size_t>(problem_.tasks))
    return;
  Peer& peer = peers_[static_cast<std::size_t>(sheet->robot)];
  peer.heard_s = now_s;
  peer.dead = false;
  if (sheet->seq > peer.last.seq) peer.last = *sheet;
}

void PlanGossip::adopt(Plan plan) {
  if (best_ && !better(plan, *best_)) return;
  const TaskSet before = tasks();
  best_ = std::move(plan);
  const TaskSet after = tasks();
  before.for_each([&](int g) { modifications_ += after.contains(g) ? 0 : 1; });
  after.for_each([&](int g) { modifications_ += before.contains(g) ? 0 : 1; });
  news_ = true;
}

TaskSet PlanGossip::tasks() const { return best_ ? best_->allocation[static_cast<std::size_t>(self_)] : TaskSet{}; }

std::vector<RobotId> PlanGossip::owners() const {
  std::vector<RobotId> result(static_cast<std::size_t>(problem_.tasks), Claim::kNobody);
  if (best_)
    for (std::size_t i = 0; i < best_->allocation.size(); ++i)
      best_->allocation[i].for_each([&](int g) { result[static_cast<std::size_t>(g)] = static_cast<RobotId>(i); });
  return result;
}

std::vector<Message> PlanGossip::act(double now_s) {
  for (std::size_t i = 0; i < peers_.size(); ++i)
    if (static_cast<RobotId>(i) != self_ && now_s > peers_[i].heard_s + times_.dead_s) peers_[i].dead = true;
  if (without() != searched_without_) restart();
  if (next_start_ < starts_) {  // one search a call: the robot listens in between
    adopt(search_->search(next_start_));
    next_start_ += stride_;
    news_ = news_ || next_start_ >= starts_;
  }
  const bool searched = next_start_ >= starts_;
  bool agreed = searched;
  for (std::size_t i = 0; i < peers_.size(); ++i) {
    if (static_cast<RobotId>(i) == self_ || peers_[i].dead) continue;
    const PlanSheet& said = peers_[i].last;
    const bool same_team = said.seq > 0 && said.without == searched_without_;
    if (same_team) {
      Plan plan{empty_allocation(problem_), said.makespan, said.total};
      for (std::size_t g = 0; g < said.owners.size(); ++g)
        if (said.owners[g] >= 0 && said.owners[g] < problem_.robots)
          plan.allocation[static_cast<std::size_t>(said.owners[g])].insert(static_cast<int>(g));
      adopt(std::move(plan));
    }
    agreed = agreed && same_team && said.searched;
  }
  const std::vector<RobotId> mine = owners();
  for (std::size_t i = 0; agreed && i < peers_.size(); ++i)
    agreed = static_cast<RobotId>(i) == self_ || peers_[i].dead || peers_[i].last.owners == mine;
  done_ = agreed;
  if (!news_ && now_s < said_s_ + times_.repeat_s) return {};
  news_ = false;
  said_s_ = now_s;
  return {PlanSheet{round_, self_, ++seq_, best_ ? best_->makespan : 0.0, best_ ? best_->total : 0.0, mine,
                    searched_without_, searched}};
}

}  // namespace outrider::auction
