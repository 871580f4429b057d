#include "comms_spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "specs.hpp"
#include "world/error.hpp"
#include "world/nearest_name.hpp"

namespace outrider::app {
namespace {

/// Reads one piece of the list from left to right.
class Piece {
 public:
  explicit Piece(const std::string& text) : text_(text), rest_(text) {}

  [[noreturn]] void fail(const std::string& expected) const {
    throw InputError(fmt::format("--comms {}: expected {}", text_, expected));
  }
  bool take(std::string_view token) {
    if (!rest_.starts_with(token)) return false;
    rest_.remove_prefix(token.size());
    return true;
  }
  double number(double low, double high, const std::string& expected) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value, std::chars_format::fixed);
    if (error != std::errc() || !(value >= low && value <= high)) fail(expected);
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value;
  }
  int count(const std::string& expected) {
    int value = 0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc() || value < 1 || value > 10000) fail(expected);
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value;
  }
  std::vector<RobotId> robots(const std::vector<RobotSpec>& team) {
    std::vector<RobotId> ids;
    for (const std::string& name : split(std::string(rest_), '+'))
      ids.push_back(robot_called(name, "--comms " + text_, team));
    if (ids.empty()) fail("names of robots joined by '+'");
    std::sort(ids.begin(), ids.end());
    rest_ = {};
    return ids;
  }
  void end(const std::string& expected) const {
    if (!rest_.empty()) fail(expected);
  }

 private:
  const std::string& text_;
  std::string_view rest_;
};

constexpr double kMost = 1e9;

link::RandomBreaks random_breaks(Piece& piece) {
  const std::string expected = "breaks:NxS, N breaks of S seconds, or breaks:NxS@H to end within H seconds";
  link::RandomBreaks breaks;
  breaks.count = piece.count(expected);
  if (!piece.take("x")) piece.fail(expected);
  breaks.seconds = piece.number(1e-3, 1e6, expected);
  piece.take("s");
  if (piece.take("@")) {
    breaks.within_s = piece.number(breaks.count * breaks.seconds, kMost, "H to be at least N times S");
    piece.take("s");
  }
  piece.end(expected);
  return breaks;
}

link::Break one_break(Piece& piece, link::Break::Kind kind, const std::vector<RobotSpec>& team) {
  const bool is_split = kind == link::Break::Kind::kSplit;
  const std::string expected = is_split ? "split:T0-T1:ROBOT+ROBOT..." : "break:T0-T1 or break:T0-T1:ROBOT+ROBOT...";
  link::Break b{kind, piece.number(0.0, kMost, expected), 0.0, {}};
  piece.take("s");
  if (!piece.take("-")) piece.fail(expected);
  b.end_s = piece.number(b.begin_s, kMost, "T1 not before T0");
  piece.take("s");
  if (piece.take(":")) b.robots = piece.robots(team);
  else if (is_split) piece.fail(expected);
  piece.end(expected);
  return b;
}

void parse_piece(const std::string& text, const std::vector<RobotSpec>& team, link::RadioSpec& spec) {
  static const std::vector<std::string> kinds{"ideal", "none", "range", "los", "loss", "delay", "breaks", "break", "split"};
  const std::string kind = text.substr(0, text.find(':'));
  if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
    throw InputError(fmt::format("--comms {}: unknown '{}'{}", text, kind, suggestion(kind, kinds)));
  Piece piece(text);
  piece.take(kind);
  if (kind == "ideal" || kind == "none" || kind == "los") {
    piece.end(kind + " alone");
    spec.none = spec.none || kind == "none";
    spec.line_of_sight = spec.line_of_sight || kind == "los";
    return;
  }
  if (!piece.take(":")) piece.fail(kind + ":...");
  if (kind == "range") {
    spec.range_m = piece.number(0.0, kMost, "range:R, a distance in metres");
    piece.take("m");
    piece.end("range:R, a distance in metres");
  } else if (kind == "loss") {
    spec.loss = piece.number(0.0, 1.0, "loss:P, a probability from 0 to 1");
    piece.end("loss:P, a probability from 0 to 1");
  } else if (kind == "delay") {
    spec.delay_s = piece.number(0.0, kMost, "delay:S, seconds");
    piece.take("s");
    piece.end("delay:S, seconds");
  } else if (kind == "breaks") {
    spec.random_breaks.push_back(random_breaks(piece));
  } else {
    spec.breaks.push_back(
        one_break(piece, kind == "split" ? link::Break::Kind::kSplit : link::Break::Kind::kSilence, team));
  }
}

}  // namespace

link::RadioSpec parse_comms(const std::string& spec, const std::vector<RobotSpec>& team) {
  link::RadioSpec radio;
  const auto pieces = split(spec, ',');
  if (pieces.empty()) throw InputError("--comms: expected 'ideal', 'none' or what is wrong with the radio, not nothing");
  for (const std::string& piece : pieces) parse_piece(piece, team, radio);
  if (radio.none && std::find(pieces.begin(), pieces.end(), "ideal") != pieces.end())
    throw InputError(fmt::format("--comms {}: expected 'ideal' or 'none', not both", spec));
  return radio;
}

}  // namespace outrider::app
