#pragma once
// The makespan search (makespan.hpp) as messages, as tolerant as D-SSA: every robot tries its share of the beginnings and
// repeats the best whole plan that it knows of. Plans are totally ordered, so all end with the same one. It asks more of
// step 2 than SSA does: each robot must know what a task set costs the others, as robots with one map do.

#include <optional>

#include "auction/makespan.hpp"
#include "auction/negotiator.hpp"

namespace outrider::auction {

class PlanGossip final : public Negotiator {
 public:
  static constexpr int kMostRobots = 64;
  /// `starts` beginnings are shared out among the robots. `problem` must outlive this.
  PlanGossip(const BundleProblem& problem, RobotId self, RoundId round, const NegotiationTimes& times, std::uint64_t seed,
             int starts, double now_s);

  void hear(const Message& message, double now_s) override;
  std::vector<Message> act(double now_s) override;
  TaskSet tasks() const override;
  bool done() const override { return done_; }
  int modifications() const override { return modifications_; }
  const std::optional<Plan>& plan() const { return best_; }

 private:
  struct Peer {
    double heard_s = 0.0;
    bool dead = false;
    PlanSheet last;
  };

  void restart();
  void adopt(Plan plan);
  std::uint64_t without() const;
  std::vector<RobotId> owners() const;

  const BundleProblem& problem_;
  RobotId self_;
  RoundId round_;
  NegotiationTimes times_;
  std::uint64_t seed_;
  int starts_;
  std::vector<Peer> peers_;
  std::optional<MakespanSearch> search_;  // among the living
  std::uint64_t searched_without_ = 0;
  int next_start_ = 0, stride_ = 1;
  std::optional<Plan> best_;
  bool news_ = true, done_ = false;
  double said_s_ = 0.0;
  std::uint32_t seq_ = 0;
  int modifications_ = 0;
};

}  // namespace outrider::auction
