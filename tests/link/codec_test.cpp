// Laws of the wire format, for every kind of message.

#include "link/codec.hpp"

#include <gtest/gtest.h>

#include "link/lc02.hpp"
#include "link/random_message.hpp"

namespace outrider::link {
namespace {

using test::MessageSource;
using Bytes = std::vector<std::uint8_t>;

const Envelope kFrom{1700000000000000, 77, 5, 42, 3};

class EveryKind : public testing::TestWithParam<std::size_t> {};

TEST_P(EveryKind, ComesBackAsItWas) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    const Message message = MessageSource(seed).draw(GetParam(), kFrom.robot);
    const Bytes bytes = encode(kFrom, message);
    const Decoded decoded = decode(channel_of(message), bytes);
    ASSERT_TRUE(decoded.packet);
    EXPECT_EQ(decoded.packet->envelope, kFrom);
    EXPECT_EQ(peek(bytes), kFrom);
    EXPECT_EQ(decoded.packet->message.index(), message.index());
    EXPECT_EQ(encode(kFrom, decoded.packet->message), bytes);
    EXPECT_EQ(encoded_size(message), make_lc02(0, channel_of(message), bytes).size());
  }
}

TEST_P(EveryKind, FitsIntoOneFrameHoweverLong) {
  const Message message = MessageSource(1, true).draw(GetParam(), kFrom.robot);
  EXPECT_LE(encoded_size(message), kMostMessageBytes);
}

TEST_P(EveryKind, AnyOtherLengthIsRefused) {
  const Message message = MessageSource(9).draw(GetParam(), kFrom.robot);
  Bytes bytes = encode(kFrom, message);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const Decoded decoded = decode(channel_of(message), std::span(bytes).first(size));
    ASSERT_FALSE(decoded.packet) << size;
    EXPECT_EQ(decoded.why, Rejection::kLength);
  }
  for (const std::size_t more : {1U, 2U, 100U}) {
    Bytes longer = bytes;
    longer.resize(bytes.size() + more);
    EXPECT_EQ(decode(channel_of(message), longer).why, Rejection::kLength);
  }
}

TEST_P(EveryKind, WhateverIsAcceptedOfMutatedBytesIsWhatTheySay) {
  std::mt19937_64 random(GetParam() + 1);
  std::size_t accepted = 0;
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    const Message message = MessageSource(seed).draw(GetParam(), kFrom.robot);
    Bytes bytes = encode(kFrom, message);
    for (std::uint64_t flips = 1 + random() % 4; flips > 0; --flips) {
      const std::size_t at = random() % 2 ? random() % std::min<std::size_t>(bytes.size(), 200) : random() % bytes.size();
      bytes[at] = random() % 3 == 0 ? 0xFF : static_cast<std::uint8_t>(random());
    }
    if (random() % 8 == 0) bytes.resize(random() % (bytes.size() + 50));
    const Decoded decoded = decode(channel_of(message), bytes);
    if (!decoded.packet) continue;
    ++accepted;
    Bytes again = encode(decoded.packet->envelope, decoded.packet->message);
    for (std::size_t k = kMacOffset; k < kMacOffset + kMacBytes; ++k) again[k] = bytes[k];
    ASSERT_EQ(again, bytes) << "seed " << seed;
  }
  EXPECT_GT(accepted, 0U);
}

TEST_P(EveryKind, HugeAndNegativeCountsAreRefusedBeforeAnythingIsAllocated) {
  const Message message = MessageSource(4).draw(GetParam(), kFrom.robot);
  const Bytes bytes = encode(kFrom, message);
  for (std::size_t at = kMacOffset + kMacBytes; at + 1 < bytes.size() && at < 220; ++at)
    for (const auto& [high, low] : {std::pair{0x7F, 0xFF}, {0xFF, 0xFF}, {0x80, 0x00}}) {
      Bytes bomb = bytes;
      bomb[at] = static_cast<std::uint8_t>(high);
      bomb[at + 1] = static_cast<std::uint8_t>(low);
      const Decoded decoded = decode(channel_of(message), bomb);
      EXPECT_TRUE(!decoded.packet || encoded_size(decoded.packet->message) <= kMostMessageBytes);
    }
}

TEST_P(EveryKind, IsRefusedOnAnotherChannel) {
  const Message message = MessageSource(2).draw(GetParam(), kFrom.robot);
  const Message other = MessageSource(2).draw((GetParam() + 1) % MessageSource::kKinds, kFrom.robot);
  EXPECT_EQ(decode(channel_of(other), encode(kFrom, message)).why, Rejection::kType);
  EXPECT_EQ(decode("OUTRIDER", encode(kFrom, message)).why, Rejection::kChannel);
}

INSTANTIATE_TEST_SUITE_P(All, EveryKind, testing::Range<std::size_t>(0, MessageSource::kKinds));

TEST(Codec, AStatusKeepsEveryField) {
  StatusMessage m{.robot = 3, .seq = 4000000000U, .pose = {1.25, -2.5, 0.1}, .goal = Cell{7, 9}, .way = {{1, 2}, {3, 4}}};
  m.speed = 0.6;
  m.range = 8.0;
  m.radius = 0.2;
  m.explored_rate = 1.5;
  m.done = true;
  m.priority = -4;
  m.asks = 2;
  m.map_hash = 0xFEDCBA9876543210U;
  m.epoch = {17, 5};
  const auto decoded = decode("OUTRIDER_STATUS", encode(kFrom, m));
  ASSERT_TRUE(decoded.packet);
  const auto& got = std::get<StatusMessage>(decoded.packet->message);
  EXPECT_EQ(got.robot, 3);
  EXPECT_EQ(got.seq, m.seq);
  EXPECT_EQ(got.pose, m.pose);
  EXPECT_EQ(got.goal, m.goal);
  EXPECT_EQ(got.way, m.way);
  EXPECT_EQ(got.speed, 0.6);
  EXPECT_EQ(got.range, 8.0);
  EXPECT_EQ(got.radius, 0.2);
  EXPECT_EQ(got.explored_rate, 1.5);
  EXPECT_TRUE(got.done);
  EXPECT_EQ(got.priority, -4);
  EXPECT_EQ(got.asks, 2);
  EXPECT_EQ(got.map_hash, m.map_hash);
  EXPECT_EQ(got.epoch, m.epoch);
}

TEST(Codec, NumbersThatCannotBeAreRefused) {
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300}) {
    StatusMessage status{.robot = 3, .seq = 1};
    status.pose.y = bad;
    EXPECT_EQ(decode("OUTRIDER_STATUS", encode(kFrom, status)).why, Rejection::kValue) << bad;
    BidSheet sheet{{0, 1}, 3, {}, 1.0, 1.0};
    sheet.entries = {{{1, 1}, {1, 1}, 1.0F, static_cast<float>(bad)}};
    EXPECT_EQ(decode("OUTRIDER_BIDS", encode(kFrom, sheet)).why, Rejection::kValue) << bad;
  }
  const BidSheet still{{0, 1}, 3, {}, 0.0, 1.0};  // bids are divided by the speed
  EXPECT_EQ(decode("OUTRIDER_BIDS", encode(kFrom, still)).why, Rejection::kValue);
}

TEST(Lc02, IsWhatLcmSends) {
  const Bytes payload{1, 2, 3};
  const Bytes datagram = make_lc02(0x01020304, "AB", payload);
  EXPECT_EQ(datagram, (Bytes{'L', 'C', '0', '2', 1, 2, 3, 4, 'A', 'B', 0, 1, 2, 3}));
  const auto parsed = parse_lc02(datagram);
  const auto& frame = std::get<Lc02>(parsed);
  EXPECT_EQ(frame.sequence, 0x01020304U);
  EXPECT_EQ(frame.channel, "AB");
  EXPECT_TRUE(std::equal(frame.payload.begin(), frame.payload.end(), payload.begin(), payload.end()));
}

TEST(Lc02, WhatKillsLiblcmIsRefused) {
  const auto why = [](const Bytes& datagram) { return std::get<Rejection>(parse_lc02(datagram)); };
  for (std::size_t size = 0; size < 8; ++size) EXPECT_EQ(why(Bytes(size, 'L')), Rejection::kNoLcm);
  // Two fragments whose offset wraps around: SIGSEGV in liblcm 1.3.1.
  EXPECT_EQ(why({'L', 'C', '0', '3', 0, 0, 0, 1, 0, 0, 16, 0, 0, 0, 0, 0, 0, 0, 0, 2, 'X', 0}), Rejection::kFragment);
  EXPECT_EQ(why({'L', 'C', '0', '3', 0, 0, 0, 1, 0, 0, 16, 0, 0xFF, 0xFF, 0xFF, 0xF0, 0, 1, 0, 2}), Rejection::kFragment);
  EXPECT_EQ(why({'L', 'C', '0', '2', 0, 0, 0, 1, 'A', 'B'}), Rejection::kNoLcm) << "a channel without an end";
  Bytes long_channel{'L', 'C', '0', '2', 0, 0, 0, 1};
  long_channel.insert(long_channel.end(), 64, 'A');
  long_channel.push_back(0);
  EXPECT_EQ(why(long_channel), Rejection::kNoLcm);
}

}  // namespace
}  // namespace outrider::link
