#include "link/ether.hpp"

#include "link/codec.hpp"

#include <gtest/gtest.h>

namespace outrider::link {
namespace {

StatusMessage hello(std::uint32_t seq) { return {.robot = 0, .seq = seq}; }

std::vector<std::uint32_t> heard(Bus& bus) {
  std::vector<std::uint32_t> seqs;
  for (const auto& d : bus.receive()) seqs.push_back(std::get<StatusMessage>(*d.message).seq);
  return seqs;
}

TEST(Ether, IdealRadioReachesEverybodyButTheSenderAtOnceAndInOrder) {
  Ether ether(3, ideal_link());
  ether.endpoint(0).send(hello(1));
  ether.endpoint(0).send(hello(2));
  EXPECT_TRUE(ether.pending());
  EXPECT_EQ(heard(ether.endpoint(1)), (std::vector<std::uint32_t>{1, 2}));
  EXPECT_EQ(heard(ether.endpoint(2)), (std::vector<std::uint32_t>{1, 2}));
  EXPECT_TRUE(heard(ether.endpoint(0)).empty());
  EXPECT_FALSE(ether.pending());
  EXPECT_EQ(ether.counters().sent, 2U);
  EXPECT_EQ(ether.counters().delivered, 4U);
  EXPECT_EQ(ether.counters().bytes, 2 * encoded_size(Message(hello(1))));
}

TEST(Ether, DelayedMessagesArriveWhenTheirTimeHasCome) {
  Ether ether(2, [](RobotId, RobotId, double now) { return std::optional(now < 0.5 ? 2.0 : 0.1); });
  ether.set_time(0.0);
  ether.endpoint(0).send(hello(1));  // arrives at 2.0
  ether.set_time(1.0);
  ether.endpoint(0).send(hello(2));  // arrives at 1.1: overtakes
  EXPECT_FALSE(ether.pending());
  ether.set_time(1.5);
  EXPECT_EQ(heard(ether.endpoint(1)), (std::vector<std::uint32_t>{2}));
  ether.set_time(2.0);
  EXPECT_EQ(heard(ether.endpoint(1)), (std::vector<std::uint32_t>{1}));
}

TEST(Ether, LostMessagesCountAsSentOnly) {
  Ether ether(2, [](RobotId, RobotId, double) { return std::optional<double>(); });
  ether.endpoint(0).send(hello(1));
  EXPECT_FALSE(ether.pending());
  EXPECT_EQ(ether.counters().sent, 1U);
  EXPECT_EQ(ether.counters().delivered, 0U);
}

}  // namespace
}  // namespace outrider::link
