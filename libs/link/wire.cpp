#include "link/wire.hpp"

#include "link/wire_numbers.hpp"

namespace outrider::link {
namespace {

using namespace outrider_wire;

bool on_grid(const cell_t& c) { return c.x >= 0 && c.y >= 0; }

cell_t cell(Cell c) {
  cell_t wire{};
  wire.x = i16(c.x);
  wire.y = i16(c.y);
  return wire;
}
Cell cell(const cell_t& c) { return {c.x, c.y}; }

void put(const Pose2& pose, double (&wire)[3]) {
  wire[0] = pose.x;
  wire[1] = pose.y;
  wire[2] = pose.theta;
}
Pose2 pose(const double (&wire)[3]) { return {wire[0], wire[1], wire[2]}; }

/// An absent goal travels as cell (0, 0).
template <class Wire>
void put_goal(const std::optional<Cell>& goal, Wire& wire) {
  wire.has_goal = goal.has_value();
  wire.goal = cell(goal.value_or(Cell{}));
}
template <class Wire>
std::optional<Cell> goal(const Wire& wire) {
  return wire.has_goal ? std::optional(cell(wire.goal)) : std::nullopt;
}
template <class Wire>
bool sane_goal(const Wire& wire) {
  return truth(wire.has_goal) && on_grid(wire.goal) && (wire.has_goal || (wire.goal.x == 0 && wire.goal.y == 0));
}

/// A name is shown to people and names files: [A-Za-z0-9_-] only.
bool plain(const std::vector<std::uint8_t>& text) {
  return all(text, [](std::uint8_t c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' || c == '-';
  });
}

}  // namespace

status_t to_wire(const StatusMessage& m) {
  status_t w{};
  put(m.pose, w.pose);
  w.speed = m.speed;
  w.range = m.range;
  w.radius = m.radius;
  w.explored_rate = m.explored_rate;
  w.map_hash = std::bit_cast<std::int64_t>(m.map_hash);
  w.seq = i32(m.seq);
  w.epoch = i32(m.epoch.count);
  w.seller = i16(m.epoch.seller);
  w.priority = m.priority;
  w.asks = i16(m.asks.value_or(-1));
  w.done = m.done;
  put_goal(m.goal, w);
  w.n_way = i16(m.way.size());
  w.way = each<cell_t>(m.way, [](Cell c) { return cell(c); });
  w.n_heard = i16(m.heard.size());
  w.heard = robots(m.heard);
  return w;
}

std::optional<Message> from_wire(const status_t& w, RobotId sender) {
  if (!sane(w.pose) || !size(w.speed) || !size(w.range) || !size(w.radius) || !size(w.explored_rate)) return {};
  if (w.seller < 0 || w.asks < -1 || !truth(w.done) || !sane_goal(w) || !all(w.way, on_grid) || !robots(w.heard)) return {};
  StatusMessage m{.robot = sender, .seq = u32(w.seq), .pose = pose(w.pose)};
  m.goal = goal(w);
  m.way = each<Cell>(w.way, [](const cell_t& c) { return cell(c); });
  m.speed = w.speed;
  m.range = w.range;
  m.radius = w.radius;
  m.explored_rate = w.explored_rate;
  m.done = w.done == 1;
  m.priority = w.priority;
  if (w.asks >= 0) m.asks = w.asks;
  m.map_hash = std::bit_cast<std::uint64_t>(w.map_hash);
  m.epoch = {u32(w.epoch), w.seller};
  m.heard = {w.heard.begin(), w.heard.end()};
  return m;
}

map_update_t to_wire(const MapUpdate& m) {
  map_update_t w{};
  w.seq = i32(m.seq);
  w.n_runs = i16(m.runs.size());
  w.runs = each<cell_run_t>(m.runs, [](const CellRun& run) {
    cell_run_t r{};
    r.index = i32(run.index);
    r.length = run.length;
    r.value = run.value;
    return r;
  });
  return w;
}

std::optional<Message> from_wire(const map_update_t& w, RobotId sender) {
  return MapUpdate{sender, u32(w.seq), each<CellRun>(w.runs, [](const cell_run_t& run) {
                     return CellRun{u32(run.index), run.length, run.value};
                   })};
}

map_digest_t to_wire(const MapDigest& m) {
  map_digest_t w{};
  w.first = i32(m.first);
  w.n_marks = i16(m.marks.size());
  w.marks = each<tile_mark_t>(m.marks, [](const TileMark& mark) {
    tile_mark_t t{};
    t.weight = i32(mark.weight);
    t.hash = i32(mark.hash);
    return t;
  });
  return w;
}

std::optional<Message> from_wire(const map_digest_t& w, RobotId sender) {
  if (w.first < 0) return {};
  return MapDigest{sender, u32(w.first), each<TileMark>(w.marks, [](const tile_mark_t& mark) {
                     return TileMark{u32(mark.weight), u32(mark.hash)};
                   })};
}

tile_request_t to_wire(const TileRequest& m) {
  tile_request_t w{};
  w.to = i16(m.to);
  w.n_tiles = i16(m.tiles.size());
  w.tiles = each<std::int32_t>(m.tiles, i32);
  return w;
}

std::optional<Message> from_wire(const tile_request_t& w, RobotId sender) {
  if (w.to < 0) return {};
  return TileRequest{sender, w.to, each<std::uint32_t>(w.tiles, u32)};
}

map_tile_t to_wire(const MapTile& m) {
  map_tile_t w{};
  w.tile = i32(m.tile);
  w.n_cells = i16(m.cells.size());
  w.cells = m.cells;
  return w;
}

std::optional<Message> from_wire(const map_tile_t& w, RobotId sender) { return MapTile{sender, u32(w.tile), w.cells}; }

round_open_t to_wire(const RoundOpen& m) {
  round_open_t w{};
  w.count = i32(m.round.count);
  w.n_heard = i16(m.heard.size());
  w.heard = robots(m.heard);
  w.n_asked = i16(m.asked.size());
  w.asked = robots(m.asked);
  return w;
}

std::optional<Message> from_wire(const round_open_t& w, RobotId sender) {
  if (!robots(w.heard) || !robots(w.asked)) return {};
  return RoundOpen{{sender, u32(w.count)}, {w.heard.begin(), w.heard.end()}, {w.asked.begin(), w.asked.end()}};
}

bid_sheet_t to_wire(const BidSheet& m) {
  bid_sheet_t w{};
  w.opener = i16(m.round.opener);
  w.count = i32(m.round.count);
  w.epoch = i32(m.epoch);
  w.part = i16(m.part);
  w.parts = i16(m.parts);
  put(m.pose, w.pose);
  w.speed = m.speed;
  w.range = m.range;
  w.explored_rate = m.explored_rate;
  w.busy = m.busy;
  put_goal(m.goal, w);
  w.n_entries = i16(m.entries.size());
  w.entries = each<bid_entry_t>(m.entries, [](const BidEntry& entry) {
    bid_entry_t e{};
    e.task = cell(entry.task);
    e.stand = cell(entry.stand);
    e.gain = entry.gain;
    e.distance = entry.distance;
    return e;
  });
  return w;
}

std::optional<Message> from_wire(const bid_sheet_t& w, RobotId sender) {
  if (w.opener < 0 || w.parts < 1 || w.parts > BidSheet::kMostParts || w.part < 0 || w.part >= w.parts) return {};
  if (!sane(w.pose) || !size(w.speed) || !size(w.range) || !size(w.explored_rate)) return {};
  if (w.speed == 0.0 || w.range == 0.0 || !truth(w.busy) || !sane_goal(w)) return {};  // bids are divided by these
  const bool good = all(w.entries, [](const bid_entry_t& e) {
    return on_grid(e.task) && on_grid(e.stand) && size(e.gain) && size(e.distance);
  });
  if (!good) return {};
  BidSheet m{{w.opener, u32(w.count)}, sender, pose(w.pose), w.speed, w.range, w.explored_rate, w.busy == 1, goal(w)};
  m.entries = each<BidEntry>(w.entries, [](const bid_entry_t& e) {
    return BidEntry{cell(e.task), cell(e.stand), e.gain, e.distance};
  });
  m.epoch = u32(w.epoch);
  m.part = w.part;
  m.parts = w.parts;
  return m;
}

awards_t to_wire(const Awards& m) {
  awards_t w{};
  w.count = i32(m.round.count);
  w.epoch = i32(m.epoch);
  w.n_bidders = i16(m.bidders.size());
  w.n_awards = i16(m.awards.size());
  w.bidders = robots(m.bidders);
  w.awards = each<award_t>(m.awards, [](const Award& award) {
    award_t a{};
    a.robot = i16(award.robot);
    a.task = cell(award.task);
    a.stand = cell(award.stand);
    a.value = award.value;
    return a;
  });
  return w;
}

std::optional<Message> from_wire(const awards_t& w, RobotId sender) {
  const bool good = all(w.awards, [](const award_t& a) {
    return a.robot >= 0 && on_grid(a.task) && on_grid(a.stand) && std::isfinite(a.value);
  });
  if (!good || !robots(w.bidders)) return {};
  Awards m{{sender, u32(w.count)}, u32(w.epoch), {w.bidders.begin(), w.bidders.end()}, {}};
  m.awards = each<Award>(w.awards, [](const award_t& a) {
    return Award{a.robot, cell(a.task), cell(a.stand), a.value};
  });
  return m;
}

introduction_t to_wire(const Introduction& m) {
  introduction_t w{};
  w.resolution = m.geometry.resolution;
  w.origin[0] = m.geometry.origin.x;
  w.origin[1] = m.geometry.origin.y;
  w.width = m.geometry.width;
  w.height = m.geometry.height;
  put(m.spec.start, w.start);
  w.speed = m.spec.speed;
  w.range = m.spec.range;
  w.fov = m.spec.fov;
  w.beams = m.spec.beams;
  w.radius = m.spec.radius;
  w.time_scale = m.time_scale;
  w.team = i16(m.team);
  w.n_name = i16(m.spec.name.size());
  w.n_coordinator = i16(m.coordinator.size());
  w.name.assign(m.spec.name.begin(), m.spec.name.end());
  w.coordinator.assign(m.coordinator.begin(), m.coordinator.end());
  return w;
}

std::optional<Message> from_wire(const introduction_t& w, RobotId sender) {
  constexpr int kMostSide = 32767;  // cells travel as int16
  if (!size(w.resolution) || w.resolution < 1e-3 || !sane(w.origin[0]) || !sane(w.origin[1])) return {};
  if (w.width < 1 || w.width > kMostSide || w.height < 1 || w.height > kMostSide || w.team < 1) return {};
  if (!sane(w.start) || !size(w.speed) || !size(w.range) || !size(w.fov) || !size(w.radius) || w.beams < 0) return {};
  if (!size(w.time_scale) || w.time_scale < 1e-3) return {};
  if (w.name.empty() || !plain(w.name) || !plain(w.coordinator)) return {};
  Introduction m;
  m.robot = sender;
  m.spec = {{w.name.begin(), w.name.end()}, pose(w.start), w.speed, w.range, w.fov, w.beams, w.radius};
  m.geometry = {w.resolution, {w.origin[0], w.origin[1]}, w.width, w.height};
  m.coordinator = {w.coordinator.begin(), w.coordinator.end()};
  m.team = w.team;
  m.time_scale = w.time_scale;
  return m;
}

}  // namespace outrider::link
