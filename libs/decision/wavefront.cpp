#include "decision/wavefront.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace outrider::decision {
namespace {

constexpr std::uint32_t kBlocked = 0, kFar = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kEdge = 70, kDiagonal = 99;
constexpr std::uint32_t kZero = 1U << 18U;   // the level of a goal of value 1; goals worth more are below
constexpr std::uint32_t kLeast = 1U, kMost = 1U << 31U;
constexpr unsigned kBucketBits = 6;          // buckets of 64: no wider than the shortest step
constexpr std::size_t kRing = 4;             // a step leads at most three buckets on

std::uint32_t bucket_of(std::uint32_t level) { return level >> kBucketBits; }

}  // namespace

/// Calls visit(neighbour, length) for the possible steps between `cell` and its neighbours, which go both ways.
template <class Visit>
void Wavefront::for_steps(std::uint32_t cell, Visit&& visit) const {
  const auto stride = static_cast<std::uint32_t>(geometry_.width + 2);
  const std::uint32_t up = cell + stride, down = cell - stride;
  const bool e = levels_[cell + 1] != kBlocked, w = levels_[cell - 1] != kBlocked;
  const bool n = levels_[up] != kBlocked, s = levels_[down] != kBlocked;
  if (e) visit(cell + 1, kEdge);
  if (w) visit(cell - 1, kEdge);
  if (n) visit(up, kEdge);
  if (s) visit(down, kEdge);
  if (n && e && levels_[up + 1] != kBlocked) visit(up + 1, kDiagonal);
  if (n && w && levels_[up - 1] != kBlocked) visit(up - 1, kDiagonal);
  if (s && e && levels_[down + 1] != kBlocked) visit(down + 1, kDiagonal);
  if (s && w && levels_[down - 1] != kBlocked) visit(down - 1, kDiagonal);
}

/// One seed a goal cell, by cell; of two goals on one cell the better.
std::vector<Wavefront::Seed> Wavefront::seeds_of(std::span<const Goal> goals) const {
  std::vector<Seed> seeds;
  seeds.reserve(goals.size());
  for (const Goal& goal : goals) {
    if (!geometry_.contains(goal.cell) || goal.value <= 0.0) continue;
    const double cells = std::log(goal.value) / std::log(gamma_) / geometry_.resolution;
    const double level = std::round(kZero + kEdge * cells);
    seeds.push_back({static_cast<std::uint32_t>(std::clamp<double>(level, kLeast, kMost)), padded(goal.cell)});
  }
  std::sort(seeds.begin(), seeds.end(), [](const Seed& a, const Seed& b) {
    return std::pair(a.cell, a.level) < std::pair(b.cell, b.level);
  });
  const auto same = [](const Seed& a, const Seed& b) { return a.cell == b.cell; };
  seeds.erase(std::unique(seeds.begin(), seeds.end(), same), seeds.end());
  return seeds;
}

void Wavefront::compute(const Grid<std::uint8_t>& mask, std::span<const Goal> goals, double gamma) {
  assert(gamma > 0.0 && gamma < 1.0);
  geometry_ = mask.geometry();
  gamma_ = gamma;
  const auto width = static_cast<std::size_t>(mask.width()), height = static_cast<std::size_t>(mask.height());
  levels_.assign((width + 2) * (height + 2), kBlocked);
  for (std::size_t y = 0; y < height; ++y) {
    const std::uint8_t* from = mask.data().data() + y * width;
    std::uint32_t* to = levels_.data() + (y + 1) * (width + 2) + 1;
    for (std::size_t x = 0; x < width; ++x) to[x] = from[x] != 0 ? kFar : kBlocked;
  }
  goal_levels_.assign(levels_.size(), kFar);
  goals_ = seeds_of(goals);
  std::vector<Seed> seeds = goals_;
  for (const Seed& seed : seeds) levels_[seed.cell] = goal_levels_[seed.cell] = seed.level;
  flood(seeds);
}

/// Lowers levels from the seeds, whose own levels are set, until nothing can be lowered.
void Wavefront::flood(std::vector<Seed>& seeds) {
  std::sort(seeds.begin(), seeds.end());
  std::array<std::vector<std::uint32_t>, kRing> ring;
  std::vector<std::uint32_t> now;
  std::size_t next = 0, open = 0;
  for (std::uint32_t bucket = seeds.empty() ? 0 : bucket_of(seeds[0].level); next < seeds.size() || open > 0; ++bucket) {
    if (open == 0) bucket = bucket_of(seeds[next].level);
    now.clear();
    std::swap(now, ring[bucket % kRing]);
    open -= now.size();
    for (; next < seeds.size() && bucket_of(seeds[next].level) == bucket; ++next) now.push_back(seeds[next].cell);
    for (const std::uint32_t cell : now) {
      const std::uint32_t level = levels_[cell];
      if (bucket_of(level) != bucket) continue;  // a better way was found since
      for_steps(cell, [&](std::uint32_t neighbour, std::uint32_t length) {
        if (level + length >= levels_[neighbour]) return;
        levels_[neighbour] = level + length;
        ring[bucket_of(level + length) % kRing].push_back(neighbour);
        ++open;
      });
    }
    if (now.capacity() > ring[bucket % kRing].capacity()) {  // hand the memory back
      now.clear();
      std::swap(now, ring[bucket % kRing]);
    }
  }
}

bool Wavefront::is_open(const Grid<std::uint8_t>& mask, std::uint32_t cell) const {
  const Cell c = unpadded(cell);
  return geometry_.contains(c) && (mask[c] != 0 || goal_levels_[cell] != kFar);
}

/// What the cell's level follows from: its goal and its neighbours' levels.
std::uint32_t Wavefront::best_level(std::uint32_t cell) const {
  std::uint32_t best = goal_levels_[cell];
  for_steps(cell, [&](std::uint32_t neighbour, std::uint32_t length) {
    if (levels_[neighbour] != kFar) best = std::min(best, levels_[neighbour] + length);
  });
  return best;
}

void Wavefront::update(const Grid<std::uint8_t>& mask, std::span<const std::uint32_t> changed,
                       std::span<const Goal> goals) {
  assert(mask.geometry() == geometry_);
  const std::vector<Seed> before = std::exchange(goals_, seeds_of(goals));
  std::vector<std::uint32_t> touched;
  for (const std::uint32_t index : changed) touched.push_back(padded(geometry_.cell_at(index)));
  for (const Seed& seed : before) goal_levels_[seed.cell] = kFar;
  for (const Seed& seed : goals_) goal_levels_[seed.cell] = seed.level;
  std::vector<Seed> differ;
  const auto by_cell = [](const Seed& a, const Seed& b) { return std::pair(a.cell, a.level) < std::pair(b.cell, b.level); };
  std::set_symmetric_difference(before.begin(), before.end(), goals_.begin(), goals_.end(), std::back_inserter(differ), by_cell);
  for (const Seed& seed : differ) touched.push_back(seed.cell);

  // A cell that opened is far until somebody reaches it; one that closed is suspect together with all around it.
  std::vector<std::uint32_t> suspects;
  const auto stride = static_cast<std::uint32_t>(geometry_.width + 2);
  std::vector<std::uint32_t> closed;
  for (const std::uint32_t cell : touched) {
    const bool was = levels_[cell] != kBlocked, is = is_open(mask, cell);
    suspects.push_back(cell);
    if (was == is) continue;
    if (is) levels_[cell] = kFar;
    else closed.push_back(cell);
    for (const std::uint32_t row : {cell - stride, cell, cell + stride})
      for (const std::uint32_t c : {row - 1, row, row + 1}) suspects.push_back(c);
  }
  for (const std::uint32_t cell : closed) levels_[cell] = kBlocked;
  std::sort(suspects.begin(), suspects.end());
  suspects.erase(std::unique(suspects.begin(), suspects.end()), suspects.end());
  std::erase_if(suspects, [&](std::uint32_t cell) { return levels_[cell] == kBlocked; });
  raise(suspects);
  std::vector<Seed> seeds;
  for (const std::uint32_t cell : suspects)
    if (const std::uint32_t best = best_level(cell); best < levels_[cell]) seeds.push_back({best, cell});
  for (const Seed& seed : seeds) levels_[seed.cell] = seed.level;
  flood(seeds);
}

/// Sets to far all levels that no longer follow from goals and neighbours, and adds their cells to `suspects`.
void Wavefront::raise(std::vector<std::uint32_t>& suspects) {
  std::size_t open = 0, bucket = suspects_.size();
  const auto suspect = [&](std::uint32_t cell) {
    if (levels_[cell] == kFar) return;
    const std::size_t b = bucket_of(levels_[cell]);
    if (b >= suspects_.size()) suspects_.resize(b + 1);
    suspects_[b].push_back(cell);
    bucket = std::min(bucket, b);
    ++open;
  };
  for (const std::uint32_t cell : suspects) suspect(cell);
  // By ascending level, so that what a cell depends on is decided before it.
  for (; open > 0; ++bucket) {
    for (const std::uint32_t cell : std::exchange(suspects_[bucket], {})) {
      --open;
      const std::uint32_t level = levels_[cell];
      if (level == kFar || best_level(cell) <= level) continue;
      levels_[cell] = kFar;
      suspects.push_back(cell);
      for_steps(cell, [&](std::uint32_t neighbour, std::uint32_t length) {
        if (levels_[neighbour] == level + length) suspect(neighbour);
      });
    }
  }
}

bool Wavefront::reached(Cell c) const {
  if (!geometry_.contains(c)) return false;
  const std::uint32_t level = levels_[padded(c)];
  return level != kBlocked && level != kFar;
}

double Wavefront::metres(Cell c) const {
  if (!reached(c)) return std::numeric_limits<double>::infinity();
  return (static_cast<double>(levels_[padded(c)]) - kZero) * geometry_.resolution / kEdge;
}

double Wavefront::value(Cell c) const { return reached(c) ? std::pow(gamma_, metres(c)) : 0.0; }

std::vector<Cell> Wavefront::path(Cell from) const {
  std::vector<Cell> cells;
  if (!reached(from)) return cells;
  std::uint32_t at = padded(from);
  cells.push_back(from);
  while (goal_levels_[at] != levels_[at]) {
    std::uint32_t next = at;
    for_steps(at, [&](std::uint32_t neighbour, std::uint32_t length) {
      if (next == at && levels_[neighbour] != kFar && levels_[neighbour] + length == levels_[at]) next = neighbour;
    });
    assert(next != at);
    at = next;
    cells.push_back(unpadded(at));
  }
  return cells;
}

}  // namespace outrider::decision
