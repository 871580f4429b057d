#include "explorer/map_exchange.hpp"

#include <algorithm>
#include <cmath>

namespace outrider::explorer {
namespace {

constexpr double kBurst = 0.2;  // [s] of tiles that may be sent at once

}  // namespace

void MapExchange::hear(const Message& message, double now_s) {
  if (const auto* status = std::get_if<StatusMessage>(&message)) {
    const bool differs = status->map_hash != map_.hash();
    peers_[status->robot] = {now_s, differs};
    digest_due_ = digest_due_ || differs;
  } else if (const auto* digest = std::get_if<MapDigest>(&message)) {
    compare(*digest, now_s);
  } else if (const auto* request = std::get_if<TileRequest>(&message)) {
    if (request->to != self_) return;
    for (const std::uint32_t tile : request->tiles) want(tile, now_s, true);
  } else if (const auto* tile = std::get_if<MapTile>(&message)) {
    merge(*tile, now_s);
  }
}

void MapExchange::merge(const MapTile& tile, double now_s) {
  if (tile.tile >= map_.tiling().count()) return;
  map_.merge_tile(tile.tile, tile.cells);
  requested_.erase(tile.tile);
  if (map_.tile(tile.tile) != tile.cells)
    want(tile.tile, now_s + settings_.stagger * (self_ % 8), false);
  else
    std::erase_if(wanted_, [&](const Wanted& w) { return w.tile == tile.tile && !w.asked_for; });
}

void MapExchange::want(std::uint32_t tile, double due_s, bool asked_for) {
  if (tile >= map_.tiling().count()) return;
  const auto same = std::find_if(wanted_.begin(), wanted_.end(), [&](const Wanted& w) { return w.tile == tile; });
  if (same == wanted_.end()) wanted_.push_back({tile, due_s, asked_for});
  else if (asked_for) *same = {tile, std::min(due_s, same->due_s), true};
}

void MapExchange::compare(const MapDigest& digest, double now_s) {
  TileRequest request{self_, digest.robot, {}};
  for (std::size_t k = 0; k < digest.marks.size() && digest.first + k < map_.tiling().count(); ++k) {
    const auto tile = digest.first + static_cast<std::uint32_t>(k);
    const TileMark &theirs = digest.marks[k], &ours = map_.mark(tile);
    digest_due_ = digest_due_ || theirs.weight < ours.weight;
    if (theirs == ours || theirs.weight < ours.weight) continue;
    const auto [asked, first] = requested_.try_emplace(tile, now_s);
    if (!first && now_s < asked->second + settings_.request_again) continue;
    asked->second = now_s;
    request.tiles.push_back(tile);
  }
  if (!request.tiles.empty()) requests_.push_back(std::move(request));
}

std::vector<Message> MapExchange::speak(double now_s) {
  std::vector<Message> out;
  if (digest_due_ && now_s >= digest_s_ + settings_.digest_period) {
    say_what_we_have(out);
    digest_due_ = false;
    digest_s_ = now_s;
  }
  for (TileRequest& request : requests_) out.emplace_back(std::move(request));
  requests_.clear();
  paced_s_ = std::max(paced_s_, now_s - kBurst);
  std::erase_if(wanted_, [&](const Wanted& w) {
    if (w.due_s > now_s || paced_s_ >= now_s) return false;
    paced_s_ += 1.0 / settings_.tiles_per_s;
    out.emplace_back(MapTile{self_, w.tile, map_.tile(w.tile)});
    return true;
  });
  return out;
}

/// Stretches of known tiles; short gaps are cheaper to send than a new stretch.
void MapExchange::say_what_we_have(std::vector<Message>& out) const {
  constexpr std::size_t kGap = 8;
  std::size_t last_known = 0;
  MapDigest digest{self_, 0, {}};
  const auto flush = [&] {
    if (digest.marks.empty()) return;
    digest.marks.resize(std::min(digest.marks.size(), last_known + 1 - digest.first));
    out.emplace_back(digest);
    digest.marks.clear();
  };
  for (std::size_t tile = 0; tile < map_.tiling().count(); ++tile) {
    const TileMark& mark = map_.mark(tile);
    if (mark.weight == 0 && (digest.marks.empty() || tile > last_known + kGap)) continue;
    if (digest.marks.size() == MapDigest::kMostMarks || tile > last_known + kGap) flush();
    if (digest.marks.empty()) {
      if (mark.weight == 0) continue;
      digest.first = static_cast<std::uint32_t>(tile);
    }
    digest.marks.push_back(mark);
    if (mark.weight > 0) last_known = tile;
  }
  flush();
}

bool MapExchange::settled(double now_s) const {
  return std::none_of(peers_.begin(), peers_.end(), [&](const auto& entry) {
    return entry.second.differs && now_s <= entry.second.heard_s + settings_.silent_after;
  });
}

}  // namespace outrider::explorer
