#pragma once
// D-SSA (Lozenguez et al. 2015, section 5.3) with an atomic hand-over in place of the paper's lock.
//
// The lock livelocks when two robots release at once, and loses tasks when an old bid overtakes a newer one
// (docs/missions.md). Here every task has a claim (epoch, owner), merged by the higher epoch, so that views converge
// whatever the radio does; and a task changes hands in one place: its owner offers it to the best bidder and changes
// nothing else until the answer is there; the bidder looks again at what it would cost now, and takes it (the next
// epoch) only when it still costs less than the owner saves. So value(G) grows with every hand-over.

#include <optional>
#include <random>

#include "auction/negotiator.hpp"

namespace outrider::auction {

class HandOver final : public Negotiator {
 public:
  /// `problem.burden` is asked about `self` only. `initial` is the same for everybody (step 2). `problem` must outlive
  /// this.
  HandOver(const BundleProblem& problem, RobotId self, RoundId round, const Allocation& initial,
           const NegotiationTimes& times, std::uint64_t seed, double now_s);

  void hear(const Message& message, double now_s) override;
  std::vector<Message> act(double now_s) override;
  TaskSet tasks() const override { return mine_; }
  bool done() const override { return done_; }
  int modifications() const override { return modifications_; }
  /// `robot` takes no part. To be said before anything is heard.
  void leave_out(RobotId robot) { peers_[static_cast<std::size_t>(robot)].dead = true; }
  /// Taken for dead.
  bool dead(RobotId robot) const { return peers_[static_cast<std::size_t>(robot)].dead; }

 private:
  struct Peer {
    double heard_s = 0.0;
    bool dead = false;
    std::vector<std::uint32_t> seq;      // of the last sheet of each stretch
    std::vector<std::uint64_t> hash;     // said in it
    std::vector<double> prices;
    bool content = false, done = false;
    std::uint32_t declined_at = 0;       // its last sheet when it declined; no offers until a newer one
    std::uint32_t answered = 0;          // its last offer that we answered, and how
    TaskAnswer::Verdict verdict = TaskAnswer::Verdict::kBusy;
  };
  struct Pending {
    TaskOffer offer;
    double sent_s;
  };

  void hear_sheet(const ClaimSheet& sheet);
  void hear_offer(const TaskOffer& offer);
  void hear_answer(const TaskAnswer& answer, double now_s);
  /// Takes over a claim that outranks ours.
  void merge(std::size_t task, const Claim& claim);
  void set_claim(std::size_t task, const Claim& claim);
  void bury(double now_s);
  bool heard_all() const;
  bool free(std::size_t task) const;
  bool claim_one();
  bool offer_one(double now_s);
  void judge();
  void compute_prices();
  std::uint64_t claims_hash() const;
  void append_sheets(double now_s);

  const BundleProblem& problem_;
  RobotId self_;
  RoundId round_;
  NegotiationTimes times_;
  std::mt19937_64 random_;
  std::vector<Claim> claims_;
  std::vector<double> prices_;
  TaskSet mine_;
  std::optional<TaskSet> priced_;  // the set that prices_ are about
  std::vector<Peer> peers_;
  std::optional<Pending> pending_;
  std::vector<Message> out_;
  std::uint64_t hash_ = 0;
  bool changed_ = true;  // claims, since compute_prices()
  bool news_ = true;     // something that others should know at once
  bool content_ = false, done_ = false;
  double wait_until_s_ = 0.0, said_s_;
  std::uint32_t seq_ = 0, serial_ = 0;
  int modifications_ = 0;
};

}  // namespace outrider::auction
