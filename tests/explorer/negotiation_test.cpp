// D-SSA and the makespan search as messages over bad radios; the long version is tests/soak.

#include "explorer/negotiation.hpp"

#include <gtest/gtest.h>

#include "auction/ssa.hpp"
#include "support/lossy_auctions.hpp"

namespace outrider::explorer {
namespace {

TEST(HandOver, EveryTaskEndsWithOneLivingOwnerAndNoMoveHelps) {
  for (std::uint64_t seed = 1; seed <= 250; ++seed) {
    const auto run = test::lossy_auction(seed);
    EXPECT_EQ(run.wrong, "") << "seed " << seed;
  }
}

TEST(PlanGossip, EverybodyEndsWithTheSamePlanOfTheLiving) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const auto run = test::lossy_auction(seed, true);
    EXPECT_EQ(run.wrong, "") << "seed " << seed;
  }
}

TEST(HandOver, SameSeedSameAuction) {
  const auto a = test::lossy_auction(7), b = test::lossy_auction(7);
  EXPECT_EQ(a.result.allocation, b.result.allocation);
  EXPECT_EQ(a.result.radio.sent, b.result.radio.sent);
  EXPECT_EQ(a.result.duration_s, b.result.duration_s);
}

TEST(HandOver, AnOfferThatOvertakesOrRepeatsTakesNothingTwice) {
  const auto problem = test::tour_problem(2, 3, 5);
  auction::HandOver robot(problem, 1, {}, {TaskSet(0b111), {}}, {}, 1, 0.0);
  const TaskOffer offer{{}, 0, 1, 4, 2, 0, 1e9};
  robot.hear(offer, 0.1);
  EXPECT_TRUE(robot.tasks().contains(2));
  robot.hear(offer, 0.2);  // heard once more: the same answer, nothing else
  robot.hear(TaskOffer{{}, 0, 1, 3, 1, 0, 1e9}, 0.3);  // an older one
  EXPECT_EQ(robot.tasks(), TaskSet(0b100));
  int accepted = 0;
  for (const Message& m : robot.act(0.4))
    if (const auto* answer = std::get_if<TaskAnswer>(&m)) accepted += answer->verdict == TaskAnswer::Verdict::kAccepted;
  EXPECT_EQ(accepted, 2);
}

TEST(HandOver, IsAsGoodAsSsaInTheMean) {
  double apart = 0.0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const auto problem = test::tour_problem(3, 9, seed);
    const auto initial = auction::empty_allocation(problem);
    NegotiationSettings radio;
    radio.seed = seed;
    const auto run = negotiate(3, [&](RobotId i) {
      return std::make_unique<auction::HandOver>(problem, i, RoundId{}, initial, radio.times, seed, 0.0);
    }, radio);
    apart += total_burden(problem, run.allocation) / total_burden(problem, auction::ssa(problem, initial).allocation) - 1.0;
  }
  EXPECT_LT(apart / 40, 0.02);
}

}  // namespace
}  // namespace outrider::explorer
