#include "explorer/overheard.hpp"

#include <algorithm>

#include "link/lc02.hpp"

namespace outrider::explorer {

/// A team becomes known by an introduction that passes the same guard as all that follows.
bool Overheard::meet(std::string_view channel, std::span<const std::uint8_t> payload) {
  const link::Decoded decoded = link::decode(channel, payload);
  if (!decoded.packet) return false;
  const auto& [envelope, message] = *decoded.packet;
  const auto* introduction = std::get_if<Introduction>(&message);
  if (introduction == nullptr || (run_ != 0 && envelope.run != run_)) return false;
  if (key_ && !key_->verify(payload)) return false;
  run_ = envelope.run;
  introduction_ = *introduction;
  map_.emplace(introduction->geometry);
  link::GuardSettings settings{.self = link::kObserver, .robots = introduction->team, .run = run_};
  settings.geometry = introduction->geometry;
  settings.key = key_;
  settings.most_per_s = 1e9;
  guard_.emplace(std::move(settings));
  return true;
}

std::shared_ptr<const Message> Overheard::hear(std::string_view channel, std::span<const std::uint8_t> payload, double t) {
  if (!guard_ && !meet(channel, payload)) return nullptr;
  const auto datagram = link::make_lc02(0, channel, payload);
  const auto delivery = guard_->accept(datagram, t);
  rejections_ = guard_->rejections();
  if (!delivery) return nullptr;
  ++heard_;
  bytes_ += datagram.size();
  take(delivery->from, *delivery->message, t);
  return delivery->message;
}

void Overheard::take(RobotId from, const Message& message, double t) {
  if (from == link::kObserver) return;
  OverheardRobot& robot = robots_[from];
  if (!robot.said) robot.said.emplace(introduction_.geometry);
  robot.heard_s = t;
  if (const auto* m = std::get_if<Introduction>(&message)) {
    robot.spec = m->spec;
  } else if (const auto* status = std::get_if<StatusMessage>(&message)) {
    robot.status = *status;
    robot.trajectory.push_back({t, status->pose});
  } else if (const auto* update = std::get_if<MapUpdate>(&message)) {
    for (const CellRun& run : update->runs) map_->merge(run), robot.said->merge(run);
  } else if (const auto* tile = std::get_if<MapTile>(&message)) {
    map_->merge_tile(tile->tile, tile->cells);
    robot.said->merge_tile(tile->tile, tile->cells);
  } else if (const auto* open = std::get_if<RoundOpen>(&message)) {
    auto& sheets = sheets_[from];
    if (!sheets.empty() && sheets.front().round != open->round) sheets.clear();
  } else if (const auto* sheet = std::get_if<BidSheet>(&message)) {
    auto& sheets = sheets_[sheet->round.opener];
    if (!sheets.empty() && sheets.front().round != sheet->round) sheets.clear();
    const auto same = std::find_if(sheets.begin(), sheets.end(), [&](const BidSheet& s) { return s.robot == from; });
    if (same == sheets.end()) sheets.push_back(*sheet);
    else if (same->part != sheet->part) same->entries.insert(same->entries.end(), sheet->entries.begin(), sheet->entries.end());
  } else if (const auto* awards = std::get_if<Awards>(&message)) {
    note(*awards, t);
  }
}

/// Awards are repeated; a round is noted once. The seller's own bids are never on the air.
void Overheard::note(const Awards& awards, double t) {
  constexpr std::size_t kMostAuctions = 4096;
  const auto known = std::find_if(auctions_.rbegin(), auctions_.rend(), [&](const auto& a) { return a.round == awards.round; });
  if (known != auctions_.rend()) return;
  if (auctions_.size() == kMostAuctions) auctions_.erase(auctions_.begin());
  AuctionRecord record{t, awards.round, {}, awards.awards, {}};
  if (const auto sheets = sheets_.find(awards.round.opener); sheets != sheets_.end() && !sheets->second.empty() &&
                                                            sheets->second.front().round == awards.round)
    record.sheets = std::move(sheets->second);
  sheets_.erase(awards.round.opener);
  auctions_.push_back(std::move(record));
}

}  // namespace outrider::explorer
