// Nothing passes but what the team said, and every refusal is counted under its reason.

#include "link/guard.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "link/lc02.hpp"
#include "link/random_message.hpp"
#include "world/error.hpp"

namespace outrider::link {
namespace {

using Bytes = std::vector<std::uint8_t>;

GuardSettings settings() {
  return {.self = 0, .robots = 4, .run = 42, .boot = 1000, .geometry = test::kWireGrid};
}

struct Speaker {
  Envelope envelope{0, 500, 0, 42, 1};
  std::optional<TeamKey> key;

  Bytes say(const Message& message) {
    ++envelope.sequence;
    Bytes payload = encode(envelope, message);
    if (key) key->sign(payload);
    return make_lc02(7, channel_of(message), payload);
  }
  Bytes hello() { return say(StatusMessage{.robot = envelope.robot, .seq = 1}); }
};

TeamKey key(std::uint8_t first) {
  Bytes secret(32, 9);
  secret[0] = first;
  return TeamKey(secret);
}

TEST(Guard, ATeamMateIsHeardOnce) {
  Guard guard(settings());
  Speaker mate;
  const Bytes first = mate.hello(), second = mate.hello();
  const auto delivery = guard.accept(second, 0.0);
  ASSERT_TRUE(delivery);
  EXPECT_EQ(delivery->from, 1);
  EXPECT_TRUE(guard.accept(first, 0.0)) << "out of order is no replay";
  EXPECT_FALSE(guard.accept(first, 0.0));
  EXPECT_FALSE(guard.accept(second, 0.0));
  EXPECT_EQ(guard.rejections()[Rejection::kReplay], 2U);
}

TEST(Guard, AMessageTooOldToTellIsAReplay) {
  Guard guard(settings());
  Speaker mate;
  const Bytes old = mate.hello();
  for (int k = 0; k < 63; ++k) mate.hello();
  ASSERT_TRUE(guard.accept(mate.hello(), 0.0));
  EXPECT_FALSE(guard.accept(old, 0.0));
  mate.envelope.sequence = std::numeric_limits<std::int64_t>::max() - 1;
  EXPECT_TRUE(guard.accept(mate.hello(), 0.0));
  mate.envelope.sequence = std::numeric_limits<std::int64_t>::min();
  EXPECT_FALSE(guard.accept(mate.hello(), 0.0));
}

TEST(Guard, OwnMessagesAreAnEchoAndOthersWithTheOwnNumberAreNot) {
  Guard guard(settings());
  Speaker self{.envelope = {0, 1000, 0, 42, 0}};
  EXPECT_FALSE(guard.accept(self.hello(), 3.0));
  EXPECT_EQ(guard.echo_s(), 3.0);
  Speaker twin{.envelope = {0, 1001, 0, 42, 0}};
  EXPECT_FALSE(guard.accept(twin.hello(), 4.0));
  EXPECT_EQ(guard.echo_s(), 3.0);
  EXPECT_EQ(guard.rejections()[Rejection::kTwin], 1U);
}

TEST(Guard, StrangersAreRefusedByReason) {
  Guard guard(settings());
  Speaker other_run{.envelope = {0, 5, 0, 43, 1}}, no_member{.envelope = {0, 5, 0, 42, 4}}, negative{.envelope = {0, 5, 0, 42, -1}};
  EXPECT_FALSE(guard.accept(other_run.hello(), 0.0));
  EXPECT_EQ(guard.rejections()[Rejection::kRun], 1U);
  EXPECT_FALSE(guard.accept(no_member.hello(), 0.0));
  EXPECT_FALSE(guard.accept(negative.hello(), 0.0));
  EXPECT_EQ(guard.rejections()[Rejection::kRobot], 2U);
  EXPECT_FALSE(guard.accept(make_lc02(1, "LCM_SELF_TEST", Bytes(100)), 0.0));
  EXPECT_EQ(guard.rejections()[Rejection::kChannel], 1U);
  EXPECT_FALSE(guard.accept(make_lc02(1, "OUTRIDER_STATUS", Bytes(4000)), 0.0));
  EXPECT_EQ(guard.rejections()[Rejection::kLong], 1U);
}

TEST(Guard, AnObserverAsksForMapsAndNothingElse) {
  Guard guard(settings());
  Speaker observer{.envelope = {0, 5, 0, 42, kObserver}};
  EXPECT_TRUE(guard.accept(observer.say(TileRequest{kObserver, 0, {1, 2}}), 0.0));
  EXPECT_TRUE(guard.accept(observer.say(MapDigest{kObserver, 0, {}}), 0.0));
  EXPECT_FALSE(guard.accept(observer.hello(), 0.0));
  EXPECT_FALSE(guard.accept(observer.say(MapTile{kObserver, 0, Bytes(1024)}), 0.0));
  EXPECT_EQ(guard.rejections()[Rejection::kRobot], 2U);
}

TEST(Guard, CellsOutsideTheMapAreRefused) {
  Guard guard(settings());
  Speaker mate;
  const auto cells = static_cast<std::uint32_t>(test::kWireGrid.size());
  StatusMessage outside{.robot = 1, .seq = 1, .goal = Cell{320, 0}};
  Introduction elsewhere{1, {.name = "r"}, test::kWireGrid, "daa", 4};
  elsewhere.geometry.width = 10;
  EXPECT_FALSE(guard.accept(mate.say(outside), 0.0));
  EXPECT_FALSE(guard.accept(mate.say(MapUpdate{1, 0, {{cells - 1, 2, 5}}}), 0.0));
  EXPECT_FALSE(guard.accept(mate.say(MapUpdate{1, 0, {{0xFFFFFFFF, 2, 5}}}), 0.0));
  EXPECT_FALSE(guard.accept(mate.say(Awards{{1, 1}, 1, {0}, {{0, {1, 256}, {1, 1}, 1.0}}}), 0.0));
  EXPECT_FALSE(guard.accept(mate.say(elsewhere), 0.0));
  EXPECT_FALSE(guard.accept(mate.say(Awards{{1, 1}, 1, {4}, {}}), 0.0)) << "a team of four";
  EXPECT_EQ(guard.rejections()[Rejection::kMap], 6U);
  EXPECT_TRUE(guard.accept(mate.say(MapUpdate{1, 0, {{cells - 2, 2, 5}}}), 0.0));
}

TEST(Guard, WithAKeyOthersAreNoise) {
  GuardSettings keyed = settings();
  keyed.key = key(1);
  Guard guard(keyed);
  Speaker mate{.key = key(1)}, wrong{.key = key(2)}, without;
  EXPECT_TRUE(guard.accept(mate.hello(), 0.0));
  EXPECT_FALSE(guard.accept(wrong.hello(), 0.0));
  EXPECT_FALSE(guard.accept(without.hello(), 0.0));
  EXPECT_EQ(guard.rejections()[Rejection::kKey], 2U);
  const Bytes good = mate.hello();
  for (std::size_t at = 24; at < good.size(); ++at) {  // behind the channel; every byte counts
    Bytes changed = good;
    changed[at] ^= 1U;
    EXPECT_FALSE(guard.accept(changed, 0.0)) << at;
  }
  EXPECT_TRUE(guard.accept(good, 0.0));
}

TEST(Guard, WithAKeyAnEarlierBootIsAReplayWithoutOneAForgedBootLocksNobodyOut) {
  for (const bool keyed : {true, false}) {
    GuardSettings s = settings();
    if (keyed) s.key = key(1);
    Guard guard(s);
    Speaker before{.envelope = {0, 500, 0, 42, 1}, .key = s.key}, after{.envelope = {0, 501, 0, 42, 1}, .key = s.key};
    EXPECT_TRUE(guard.accept(before.hello(), 0.0));
    EXPECT_TRUE(guard.accept(after.hello(), 0.0)) << "a restarted robot begins at 1 again";
    EXPECT_EQ(guard.accept(before.hello(), 0.0).has_value(), !keyed);
  }
}

TEST(Guard, AFloodFromOneSenderIsCutDownAndLeavesTheOthersAlone) {
  Guard guard(settings());
  Speaker loud, quiet{.envelope = {0, 5, 0, 42, 2}};
  int passed = 0;
  for (int k = 0; k < 10000; ++k) passed += guard.accept(loud.hello(), k * 1e-4).has_value();
  EXPECT_GE(passed, 2000);
  EXPECT_LE(passed, 4001);
  EXPECT_EQ(guard.rejections()[Rejection::kRate], static_cast<std::uint64_t>(10000 - passed));
  EXPECT_TRUE(guard.accept(quiet.hello(), 1.0));
}

TEST(Guard, RandomAndMutatedDatagramsDoNoHarm) {
  Guard guard(settings());
  std::mt19937_64 random(5);
  Speaker mate;
  std::size_t delivered = 0;
  for (int k = 0; k < 40000; ++k) {
    Bytes datagram = mate.say(test::MessageSource(random()).draw(random() % test::MessageSource::kKinds, 1));
    if (k % 4 == 0) datagram.resize(random() % 1400);
    for (std::uint64_t flips = random() % 6; flips > 0 && !datagram.empty(); --flips)
      datagram[random() % datagram.size()] = static_cast<std::uint8_t>(random());
    delivered += guard.accept(datagram, k * 1e-3).has_value();
  }
  std::uint64_t refused = 0;
  for (const std::uint64_t n : guard.rejections().count) refused += n;
  EXPECT_GE(delivered, 1000U);
  EXPECT_LE(delivered + refused, 40000U);
}

TEST(TeamKey, AFileThatIsNoKeyIsRefusedByName) {
  const auto file = std::filesystem::temp_directory_path() / "outrider-team-key-test";
  std::ofstream(file) << "short";
  try {
    TeamKey::read(file);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find(file.string()), std::string::npos);
  }
  std::ofstream(file) << "0123456789abcdef";
  EXPECT_NO_THROW(TeamKey::read(file));
  std::filesystem::remove(file);
  EXPECT_THROW(TeamKey::read(file), InputError);
}

}  // namespace
}  // namespace outrider::link
