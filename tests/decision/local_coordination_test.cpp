// The paper's words about close robots, as what the solved process must say.

#include "decision/local_coordination.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace outrider::decision {
namespace {

using enum Encounter;
using enum LocalAction;

constexpr Encounter kAll[] = {kFollowing, kFollowed, kFaceToFace, kDiverging};

/// How the other one sees it.
Encounter mirrored(Encounter e) { return e == kFollowing ? kFollowed : e == kFollowed ? kFollowing : e; }

TEST(LocalCoordination, WhoFollowsWaitsAndWhoIsFollowedGoesOn) {
  const LocalCoordination local;
  for (const bool emergency : {false, true})
    for (const bool first : {false, true}) {
      EXPECT_EQ(local.action(kFollowing, emergency, first), kWait);
      EXPECT_EQ(local.action(kFollowed, emergency, first), kGo);
    }
}

TEST(LocalCoordination, FaceToFaceOneWaitsAndBacktracksWhenTooClose) {
  const LocalCoordination local;
  EXPECT_EQ(local.action(kFaceToFace, false, true), kGo);
  EXPECT_EQ(local.action(kFaceToFace, false, false), kWait);
  EXPECT_EQ(local.action(kFaceToFace, true, true), kGo);
  EXPECT_EQ(local.action(kFaceToFace, true, false), kBack);
}

TEST(LocalCoordination, NobodyFreezesWhenTheyDiverge) {
  const LocalCoordination local;
  for (const bool emergency : {false, true})
    for (const bool first : {false, true}) EXPECT_EQ(local.action(kDiverging, emergency, first), kGo);
}

TEST(LocalCoordination, OneOfTwoAlwaysGoesWithSimilarCostsToo) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> factor(0.7, 1.4);
  for (int k = 0; k < 50; ++k) {
    LocalModel model;
    for (double* v : {&model.near_cost, &model.first_delay, &model.second_delay, &model.contact_cost}) *v *= factor(random);
    const LocalCoordination local(model);
    for (const Encounter e : kAll)
      for (const bool emergency : {false, true})
        EXPECT_TRUE(local.action(e, emergency, true) == kGo || local.action(mirrored(e), emergency, false) == kGo)
            << "model " << k << ", encounter " << static_cast<int>(e);
  }
}

TEST(LocalCoordination, ItsProcessIsOne) {
  const GraphMdp mdp = local_mdp({});
  for (State s = 0; s < mdp.states(); ++s)
    for (int a = 0; a < mdp.actions(s); ++a) {
      double sum = 0.0;
      mdp.outcomes(s, a, [&](State next, double p) {
        EXPECT_LT(next, mdp.states());
        EXPECT_GE(p, 0.0);
        sum += p;
      });
      EXPECT_NEAR(sum, 1.0, 1e-12);
    }
}

TEST(Encounter, TellsWhoDrivesTowardsWhom) {
  const Point a{0, 0}, b{1, 0}, right{1, 0}, left{-3, 0}, up{0, 2};
  EXPECT_EQ(encounter(a, right, b, left), kFaceToFace);
  EXPECT_EQ(encounter(a, right, b, right), kFollowing);
  EXPECT_EQ(encounter(a, left, b, left), kFollowed);
  EXPECT_EQ(encounter(a, left, b, right), kDiverging);
  EXPECT_EQ(encounter(a, right, b, up), kFollowing);  // the other crosses
  EXPECT_EQ(encounter(a, up, b, up), kDiverging);     // side by side
  EXPECT_EQ(encounter(a, {}, b, left), kFollowed);    // we stand
}

TEST(Encounter, LooksMirroredFromTheOtherSide) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int k = 0; k < 200; ++k) {
    const Point a{u(random), u(random)}, b{u(random), u(random)}, ha{u(random), u(random)}, hb{u(random), u(random)};
    EXPECT_EQ(encounter(a, ha, b, hb), mirrored(encounter(b, hb, a, ha)));
  }
}

}  // namespace
}  // namespace outrider::decision
