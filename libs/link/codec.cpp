#include "link/codec.hpp"

#include <bit>
#include <cassert>

#include "link/wire.hpp"
#include "world/task_set.hpp"

namespace outrider::link {
namespace {

std::uint64_t big_endian(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t k = 0; k < size; ++k) value = value << 8U | bytes[at + k];
  return value;
}

/// A variable array at the end of a type: size of an element on the wire, and how many there may be.
struct Array {
  std::size_t element;
  std::size_t most;
};

/// What decides the length of a payload: its fixed part, which ends in one int16 count an array, and the arrays.
struct Form {
  std::size_t fixed;
  std::array<Array, 2> arrays;  // an array of no elements at most is not there

  std::size_t counts() const { return static_cast<std::size_t>(arrays[0].most > 0) + (arrays[1].most > 0); }

  bool fits(std::span<const std::uint8_t> payload) const {
    if (payload.size() < fixed) return false;
    std::size_t expected = fixed;
    for (std::size_t k = 0; k < counts(); ++k) {
      const std::uint64_t count = big_endian(payload, fixed - 2 * (counts() - k), 2);
      if (count > arrays[k].most) return false;
      expected += static_cast<std::size_t>(count) * arrays[k].element;
    }
    return payload.size() == expected;
  }
};

template <class Element>
std::size_t element_size() {
  if constexpr (std::is_arithmetic_v<Element>) return sizeof(Element);
  else return static_cast<std::size_t>(Element{}._getEncodedSizeNoHash());
}

template <class Wire, class First = std::uint8_t, class Second = std::uint8_t>
Form form(std::size_t first = 0, std::size_t second = 0) {
  return {static_cast<std::size_t>(Wire{}.getEncodedSize()),
          {{{element_size<First>(), first}, {element_size<Second>(), second}}}};
}

/// Everything that is known of one kind of message.
struct Kind {
  std::string_view channel;
  std::int64_t fingerprint;
  Form form;
  std::optional<Message> (*parse)(std::span<const std::uint8_t>, RobotId);
};

template <class Wire>
std::optional<Message> parse(std::span<const std::uint8_t> payload, RobotId sender) {
  Wire wire{};
  const int size = static_cast<int>(payload.size());
  if (wire.decode(payload.data(), 0, size) != size) return std::nullopt;
  return from_wire(wire, sender);
}

template <class Wire>
Kind kind(std::string_view channel, const Form& form) {
  return {channel, Wire::getHash(), form, parse<Wire>};
}

/// In the order of Message's alternatives.
const std::array<Kind, std::variant_size_v<Message>>& kinds() {
  using namespace outrider_wire;
  static const std::array<Kind, std::variant_size_v<Message>> table{
      kind<status_t>("OUTRIDER_STATUS",
                     form<status_t, cell_t, std::int16_t>(StatusMessage::kMaxWay, StatusMessage::kMostHeard)),
      kind<map_update_t>("OUTRIDER_UPDATE", form<map_update_t, cell_run_t>(MapUpdate::kMostRuns)),
      kind<map_digest_t>("OUTRIDER_DIGEST", form<map_digest_t, tile_mark_t>(MapDigest::kMostMarks)),
      kind<tile_request_t>("OUTRIDER_REQUEST", form<tile_request_t, std::int32_t>(TileRequest::kMostTiles)),
      kind<map_tile_t>("OUTRIDER_TILE", form<map_tile_t>(MapTile::kMostCells)),
      kind<round_open_t>("OUTRIDER_OPEN", form<round_open_t, std::int16_t, std::int16_t>(RoundOpen::kMostHeard, RoundOpen::kMostAsked)),
      kind<bid_sheet_t>("OUTRIDER_BIDS", form<bid_sheet_t, bid_entry_t>(BidSheet::kMostEntries)),
      kind<awards_t>("OUTRIDER_AWARDS",
                     form<awards_t, std::int16_t, award_t>(Awards::kMostBidders, Awards::kMostBidders)),
      kind<introduction_t>("OUTRIDER_HELLO", form<introduction_t>(Introduction::kMostName, Introduction::kMostName)),
      kind<claim_sheet_t>("OUTRIDER_CLAIMS",
                          form<claim_sheet_t, claim_t, double>(ClaimSheet::kMostClaims, ClaimSheet::kMostClaims)),
      kind<task_offer_t>("OUTRIDER_OFFER", form<task_offer_t>()),
      kind<task_answer_t>("OUTRIDER_ANSWER", form<task_answer_t>()),
      kind<plan_sheet_t>("OUTRIDER_PLAN", form<plan_sheet_t, std::int16_t>(TaskSet::kMost))};
  return table;
}

const Kind* kind_on(std::string_view channel) {
  for (const Kind& k : kinds())
    if (k.channel == channel) return &k;
  return nullptr;
}

/// Elements of the variable arrays of a message.
struct Counts {
  using Pair = std::array<std::size_t, 2>;
  Pair operator()(const StatusMessage& m) const { return {m.way.size(), m.heard.size()}; }
  Pair operator()(const MapUpdate& m) const { return {m.runs.size(), 0}; }
  Pair operator()(const MapDigest& m) const { return {m.marks.size(), 0}; }
  Pair operator()(const TileRequest& m) const { return {m.tiles.size(), 0}; }
  Pair operator()(const MapTile& m) const { return {m.cells.size(), 0}; }
  Pair operator()(const RoundOpen& m) const { return {m.heard.size(), m.asked.size()}; }
  Pair operator()(const BidSheet& m) const { return {m.entries.size(), 0}; }
  Pair operator()(const Awards& m) const { return {m.bidders.size(), m.awards.size()}; }
  Pair operator()(const ClaimSheet& m) const { return {m.claims.size(), m.prices.size()}; }
  Pair operator()(const TaskOffer&) const { return {0, 0}; }
  Pair operator()(const TaskAnswer&) const { return {0, 0}; }
  Pair operator()(const PlanSheet& m) const { return {m.owners.size(), 0}; }
  Pair operator()(const Introduction& m) const { return {m.spec.name.size(), m.coordinator.size()}; }
};

std::size_t payload_size(const Message& message) {
  const Form& f = kinds()[message.index()].form;
  const auto counts = std::visit(Counts{}, message);
  return f.fixed + counts[0] * f.arrays[0].element + counts[1] * f.arrays[1].element;
}

}  // namespace

std::string_view channel_of(const Message& message) { return kinds()[message.index()].channel; }

bool is_channel(std::string_view channel) { return kind_on(channel) != nullptr; }

std::size_t encoded_size(const Message& message) {
  return 8 + channel_of(message).size() + 1 + payload_size(message);
}

std::vector<std::uint8_t> encode(const Envelope& envelope, const Message& message) {
  std::vector<std::uint8_t> payload(payload_size(message));
  std::visit([&](const auto& m) {
    auto wire = to_wire(m);
    wire.header = {};
    wire.header.utime = envelope.utime_us;
    wire.header.boot = envelope.boot;
    wire.header.sequence = envelope.sequence;
    wire.header.run = envelope.run;
    wire.header.robot = static_cast<std::int16_t>(envelope.robot);
    [[maybe_unused]] const int written = wire.encode(payload.data(), 0, static_cast<int>(payload.size()));
    assert(written == static_cast<int>(payload.size()));
  }, message);
  return payload;
}

std::optional<Envelope> peek(std::span<const std::uint8_t> payload) {
  if (payload.size() < kMacOffset + kMacBytes) return std::nullopt;
  const auto i64 = [&](std::size_t at) { return std::bit_cast<std::int64_t>(big_endian(payload, at, 8)); };
  return Envelope{i64(8), i64(16), i64(24), static_cast<std::int32_t>(big_endian(payload, 32, 4)),
                  static_cast<std::int16_t>(big_endian(payload, 36, 2))};
}

Decoded decode(std::string_view channel, std::span<const std::uint8_t> payload) {
  const Kind* k = kind_on(channel);
  if (k == nullptr) return {{}, Rejection::kChannel};
  const auto envelope = peek(payload);
  if (!envelope) return {{}, Rejection::kLength};
  if (std::bit_cast<std::int64_t>(big_endian(payload, 0, 8)) != k->fingerprint) return {{}, Rejection::kType};
  if (!k->form.fits(payload)) return {{}, Rejection::kLength};
  auto message = k->parse(payload, envelope->robot);
  if (!message || envelope->robot < 0) return {{}, Rejection::kValue};
  return {Packet{*envelope, std::move(*message)}, {}};
}

}  // namespace outrider::link
