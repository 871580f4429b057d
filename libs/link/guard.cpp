#include "link/guard.hpp"

#include <algorithm>

#include "link/lc02.hpp"

namespace outrider::link {

bool ReplayWindow::fresh(std::int64_t sequence) const {
  if (sequence > newest_) return true;
  // newest_ >= sequence: the difference of two positive numbers
  return sequence > 0 && newest_ - sequence < 64 && (seen_ >> static_cast<unsigned>(newest_ - sequence) & 1U) == 0;
}

void ReplayWindow::note(std::int64_t sequence) {
  if (sequence > newest_) {
    const std::int64_t ahead = sequence - newest_;
    seen_ = ahead < 64 ? seen_ << static_cast<unsigned>(ahead) : 0;
    newest_ = sequence;
  }
  seen_ |= std::uint64_t{1} << static_cast<unsigned>(newest_ - sequence);
}

std::optional<Delivery> Guard::accept(std::span<const std::uint8_t> datagram, double now_s) {
  const auto refuse = [&](Rejection why) {
    reject(why);
    return std::nullopt;
  };
  const auto frame = parse_lc02(datagram);
  if (const auto* why = std::get_if<Rejection>(&frame)) return refuse(*why);
  const auto& [sequence, channel, payload] = std::get<Lc02>(frame);
  if (!is_channel(channel)) return refuse(Rejection::kChannel);
  if (datagram.size() > kMostMessageBytes) return refuse(Rejection::kLong);
  const auto envelope = peek(payload);
  if (!envelope) return refuse(Rejection::kLength);
  if (envelope->robot == settings_.self && envelope->boot == settings_.boot && envelope->run == settings_.run) {
    echo_s_ = now_s;
    return std::nullopt;
  }
  if (const auto why = objection(*envelope, payload, now_s)) return refuse(*why);
  Decoded decoded = decode(channel, payload);
  if (!decoded.packet) return refuse(decoded.why);
  const Message& message = decoded.packet->message;
  if (!allowed(envelope->robot, message)) return refuse(Rejection::kRobot);
  if (!in_map(message)) return refuse(Rejection::kMap);
  Sender& sender = senders_[envelope->robot];
  if (sender.boot != envelope->boot) sender.window = {};
  sender.boot = envelope->boot;
  sender.window.note(envelope->sequence);
  return Delivery{envelope->robot, std::make_shared<const Message>(std::move(decoded.packet->message))};
}

std::optional<Rejection> Guard::objection(const Envelope& envelope, std::span<const std::uint8_t> payload, double now_s) {
  if (envelope.run != settings_.run) return Rejection::kRun;
  const bool member = envelope.robot >= 0 && envelope.robot < settings_.robots;
  if (!member && envelope.robot != kObserver) return Rejection::kRobot;
  if (settings_.key && !settings_.key->verify(payload)) return Rejection::kKey;
  if (envelope.robot == settings_.self) return Rejection::kTwin;
  Sender& sender = senders_.try_emplace(envelope.robot, Sender{0, {}, settings_.most_per_s, now_s}).first->second;
  // With a key boots only grow. Without one a forged boot must not lock the real robot out.
  if (settings_.key && envelope.boot < sender.boot) return Rejection::kReplay;
  if (envelope.sequence <= 0) return Rejection::kReplay;
  if (envelope.boot == sender.boot && !sender.window.fresh(envelope.sequence)) return Rejection::kReplay;
  if (too_many(sender, now_s)) return Rejection::kRate;
  return std::nullopt;
}

bool Guard::too_many(Sender& sender, double now_s) const {
  const double earned = (now_s - sender.since_s) * settings_.most_per_s;
  sender.tokens = std::min(settings_.most_per_s, sender.tokens + earned);
  sender.since_s = now_s;
  if (sender.tokens < 1.0) return true;
  sender.tokens -= 1.0;
  return false;
}

/// Every cell, tile and robot that the message names is there.
bool Guard::in_map(const Message& message) const {
  const GridGeometry& g = settings_.geometry;
  const auto inside = [&](Cell c) { return g.contains(c); };
  const auto inside_if = [&](const std::optional<Cell>& c) { return !c || g.contains(*c); };
  const auto member = [&](RobotId robot) { return robot < settings_.robots; };
  const auto all = [](const auto& list, auto&& good) { return std::all_of(list.begin(), list.end(), good); };
  if (const auto* m = std::get_if<StatusMessage>(&message))
    return inside_if(m->goal) && all(m->way, inside) && all(m->heard, member) && member(m->asks.value_or(0));
  if (const auto* m = std::get_if<MapUpdate>(&message))
    return all(m->runs, [&](const CellRun& run) { return run.index + std::size_t{run.length} <= g.size(); });
  if (const auto* m = std::get_if<RoundOpen>(&message)) return all(m->heard, member) && all(m->asked, member);
  if (const auto* m = std::get_if<BidSheet>(&message))
    return member(m->round.opener) && inside_if(m->goal) &&
           all(m->entries, [&](const BidEntry& e) { return inside(e.task) && inside(e.stand); });
  if (const auto* m = std::get_if<Awards>(&message))
    return all(m->bidders, member) &&
           all(m->awards, [&](const Award& a) { return member(a.robot) && inside(a.task) && inside(a.stand); });
  if (const auto* m = std::get_if<ClaimSheet>(&message))
    return member(m->round.opener) && all(m->claims, [&](const Claim& claim) { return member(claim.owner); });
  if (const auto* m = std::get_if<PlanSheet>(&message)) return member(m->round.opener) && all(m->owners, member);
  if (const auto* m = std::get_if<Introduction>(&message)) return m->geometry == g;
  return true;
}

/// An observer compares maps and asks for tiles; it neither reports nor bids.
bool Guard::allowed(RobotId robot, const Message& message) const {
  return robot != kObserver || std::holds_alternative<MapDigest>(message) || std::holds_alternative<TileRequest>(message);
}

}  // namespace outrider::link
