#include "decision/local_coordination.hpp"

#include <algorithm>
#include <cmath>

namespace outrider::decision {
namespace {

constexpr double kTowards = 0.5;  // cosine of 60 degrees

/// From outside: which of the two drives towards the other.
enum class Pair { kFirstFollows, kSecondFollows, kFaceToFace, kDiverging };
constexpr int kGaps = 2;  // 0: emergency, 1: close
constexpr State kClear = 8;

State joint_state(Pair pair, int gap) { return static_cast<State>(static_cast<int>(pair) * kGaps + gap); }

/// How much wider an action makes the gap, for a robot that drives towards the other or away from it.
int widening(bool towards, LocalAction action) {
  if (action == LocalAction::kWait) return 0;
  return (action == LocalAction::kGo) == towards ? -1 : 1;
}

double delay(LocalAction action) {
  return action == LocalAction::kGo ? 0.0 : action == LocalAction::kWait ? 1.0 : 3.0;
}

/// The probability that two face to face get past each other in this step.
double passing(const LocalModel& model, LocalAction first, LocalAction second) {
  if ((first == LocalAction::kGo) == (second == LocalAction::kGo)) return 0.0;
  const LocalAction other = first == LocalAction::kGo ? second : first;
  return other == LocalAction::kWait ? model.pass_standing : model.pass_backing;
}

GraphMdp::Action joint_action(const LocalModel& model, Pair pair, int gap, LocalAction first, LocalAction second) {
  const bool first_towards = pair == Pair::kFirstFollows || pair == Pair::kFaceToFace;
  const bool second_towards = pair == Pair::kSecondFollows || pair == Pair::kFaceToFace;
  GraphMdp::Action action{-model.near_cost - model.first_delay * delay(first) - model.second_delay * delay(second),
                          model.discount, {}};
  const double pass = pair == Pair::kFaceToFace ? passing(model, first, second) : 0.0;
  int next = gap + widening(first_towards, first) + widening(second_towards, second);
  if (next < 0) action.reward -= (1.0 - pass) * model.contact_cost;
  next = std::max(next, 0);
  if (pass > 0.0) action.outcomes.push_back({joint_state(Pair::kDiverging, gap), pass});
  action.outcomes.push_back({next >= kGaps ? kClear : joint_state(pair, next), 1.0 - pass});
  return action;
}

}  // namespace

Encounter encounter(Point self, Point heading, Point other, Point other_heading) {
  const auto towards = [](Point from, Point direction, Point to) {
    const double dx = to.x - from.x, dy = to.y - from.y;
    return direction.x * dx + direction.y * dy > kTowards * std::hypot(direction.x, direction.y) * std::hypot(dx, dy);
  };
  const bool mine = towards(self, heading, other), theirs = towards(other, other_heading, self);
  return mine ? theirs ? Encounter::kFaceToFace : Encounter::kFollowing
              : theirs ? Encounter::kFollowed : Encounter::kDiverging;
}

GraphMdp local_mdp(const LocalModel& model) {
  GraphMdp mdp(kClear + 1);
  for (const Pair pair : {Pair::kFirstFollows, Pair::kSecondFollows, Pair::kFaceToFace, Pair::kDiverging})
    for (int gap = 0; gap < kGaps; ++gap)
      for (int a = 0; a < 9; ++a)
        mdp.choices[joint_state(pair, gap)].push_back(
            joint_action(model, pair, gap, static_cast<LocalAction>(a / 3), static_cast<LocalAction>(a % 3)));
  return mdp;
}

LocalCoordination::LocalCoordination(const LocalModel& model) {
  const Solution solution = ValueIteration{}(local_mdp(model));
  for (State s = 0; s < kClear; ++s)
    policy_[s] = {static_cast<LocalAction>(solution.policy[s] / 3), static_cast<LocalAction>(solution.policy[s] % 3)};
}

LocalAction LocalCoordination::action(Encounter encounter, bool emergency, bool first) const {
  Pair pair = encounter == Encounter::kFaceToFace ? Pair::kFaceToFace : Pair::kDiverging;
  if (encounter == Encounter::kFollowing) pair = first ? Pair::kFirstFollows : Pair::kSecondFollows;
  if (encounter == Encounter::kFollowed) pair = first ? Pair::kSecondFollows : Pair::kFirstFollows;
  return policy_[joint_state(pair, emergency ? 0 : 1)][first ? 0 : 1];
}

}  // namespace outrider::decision
