// The bus on a real socket, in a network namespace of the test's own.

#include "link/lcm_bus.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "link/private_network.hpp"
#include "link/random_message.hpp"
#include "world/error.hpp"

namespace outrider::link {
namespace {

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// The whole test program moves once; tests on sockets come after.
bool private_network() {
  static const bool there = enter_private_network();
  return there;
}

GuardSettings settings(RobotId self, std::int32_t run = 1) {
  return {.self = self, .robots = 3, .run = run, .boot = self + 1, .geometry = test::kWireGrid};
}

LcmBus bus(RobotId self, std::int32_t run = 1) {
  return {MulticastUrl::parse("udpm://239.255.76.67:17667?ttl=0"), settings(self, run), seconds};
}

TEST(LcmBus, RobotsHearEachOtherButNotThemselvesNorOtherTeams) {
  if (!private_network()) GTEST_SKIP() << "this kernel gives no network namespace";
  LcmBus a = bus(0), b = bus(1), stranger = bus(2, 7);
  ASSERT_TRUE(a.connected()) << a.trouble();
  const auto message = test::MessageSource(1, true).draw(4, 0);  // a whole tile
  a.send(message);
  ASSERT_TRUE(b.wait(seconds() + 2.0));
  const auto got = b.receive();
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].from, 0);
  EXPECT_EQ(std::get<MapTile>(*got[0].message).cells, std::get<MapTile>(message).cells);
  EXPECT_FALSE(a.wait(seconds() + 0.01));
  EXPECT_FALSE(stranger.wait(seconds() + 0.01));
  EXPECT_EQ(stranger.rejections()[Rejection::kRun], 1U);
  EXPECT_EQ(a.counters().sent, 1U);
  EXPECT_EQ(a.counters().bytes, encoded_size(message));
}

TEST(MulticastUrl, SaysWhatIsWrong) {
  const MulticastUrl url = MulticastUrl::parse("udpm://239.255.1.2:7000?ttl=1&recv_buf_size=65536");
  EXPECT_EQ(url.port, 7000);
  EXPECT_EQ(url.ttl, 1);
  EXPECT_EQ(url.receive_buffer, 65536);
  EXPECT_EQ(MulticastUrl::parse("udpm://").ttl, 0);
  for (const char* bad : {"tcpq://1.2.3.4", "udpm://10.0.0.1:7667", "udpm://239.1.1.1:0", "udpm://239.1.1.1:99999",
                          "udpm://239.1.1.1:7667?ttl=x", "udpm://239.1.1.1:7667?tll=1", "udpm://nowhere:7667"})
    EXPECT_THROW(MulticastUrl::parse(bad), InputError) << bad;
}

}  // namespace
}  // namespace outrider::link
