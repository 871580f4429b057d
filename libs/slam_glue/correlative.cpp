#include "slam_glue/correlative.hpp"

#include <algorithm>
#include <cmath>

namespace outrider::slam_glue {
namespace {

constexpr double kLeastBlur = 0.08;   // standard deviation of the nearness [m]; at least a cell
constexpr double kLeastTurn = 0.005;  // finest step in heading [rad]
constexpr double kMostTurn = 0.03;
constexpr double kDoubt = 0.01;       // of the score, per squared standard deviation from the centre

struct CellOffset {
  int x, y;
};

}  // namespace

CorrelativeMatcher::CorrelativeMatcher(std::span<const SurfacePoint> map, double resolution_m, int levels)
    : resolution_(resolution_m) {
  if (map.empty()) return;
  Point low = map.front().p, high = low;
  for (const auto& q : map) {
    low = {std::min(low.x, q.p.x), std::min(low.y, q.p.y)};
    high = {std::max(high.x, q.p.x), std::max(high.y, q.p.y)};
  }
  const double blur = std::max(kLeastBlur, resolution_);
  const int reach = static_cast<int>(std::ceil(2.0 * blur / resolution_));
  origin_ = {low.x - (reach + 1) * resolution_, low.y - (reach + 1) * resolution_};
  width_ = static_cast<int>((high.x - origin_.x) / resolution_) + reach + 2;
  height_ = static_cast<int>((high.y - origin_.y) / resolution_) + reach + 2;
  Level base{1, std::vector<std::uint8_t>(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0),
             width_, height_};
  for (const auto& q : map) {
    const double fx = (q.p.x - origin_.x) / resolution_, fy = (q.p.y - origin_.y) / resolution_;
    const int cx = static_cast<int>(fx), cy = static_cast<int>(fy);
    for (int y = cy - reach; y <= cy + reach; ++y)
      for (int x = cx - reach; x <= cx + reach; ++x) {
        const double d = resolution_ * std::hypot(x + 0.5 - fx, y + 0.5 - fy) / blur;
        auto& cell = base.values[static_cast<std::size_t>(y * width_ + x)];
        cell = std::max(cell, static_cast<std::uint8_t>(255.0 * std::exp(-0.5 * d * d)));
      }
  }
  levels_.push_back(std::move(base));
  for (int h = 1; h < levels; ++h) {
    // Maxima over 2^h cells from maxima over 2^(h-1) cells, taken twice.
    const Level& below = levels_.back();
    Level level{2 * below.span, {}, below.width + below.span, below.height + below.span};
    level.values.assign(static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height), 0);
    const auto look = [&](int x, int y) -> std::uint8_t {
      return x < 0 || y < 0 || x >= below.width || y >= below.height
                 ? std::uint8_t{0}
                 : below.values[static_cast<std::size_t>(y * below.width + x)];
    };
    const int s = below.span;
    for (int y = 0; y < level.height; ++y)
      for (int x = 0; x < level.width; ++x)
        level.values[static_cast<std::size_t>(y * level.width + x)] =
            std::max(std::max(look(x, y), look(x - s, y)), std::max(look(x, y - s), look(x - s, y - s)));
    levels_.push_back(std::move(level));
  }
}

/// One search: the scan turned to every heading, and the best pose so far.
struct CorrelativeMatcher::Search {
  const CorrelativeMatcher& m;
  const SearchWindow& window;
  const std::optional<Pose2>& excluded;
  int shifts;
  std::vector<double> headings;
  std::vector<std::vector<CellOffset>> turned;
  double perfect;
  long best_sum;
  std::optional<Pose2> best;

  struct Block {
    int heading, x, y;  // lower left shift
    long sum;
  };

  /// What being away from the centre costs, in units of the sums.
  long doubt_of_heading(int k) const {
    if (window.sigma_rad <= 0.0) return 0;
    const double d = (headings[static_cast<std::size_t>(k)] - window.centre.theta) / window.sigma_rad;
    return static_cast<long>(kDoubt * perfect * d * d);
  }
  long doubt_of_shift(int x, int y) const {
    if (window.sigma_m <= 0.0) return 0;
    const double scale = m.resolution_ / window.sigma_m;
    return static_cast<long>(kDoubt * perfect * scale * scale * (x * x + y * y));
  }
  long sum(const Level& level, const std::vector<CellOffset>& points, int x, int y) const {
    long total = 0;
    const int dx = x + level.span - 1, dy = y + level.span - 1;
    for (const CellOffset& p : points) {
      const int cx = p.x + dx, cy = p.y + dy;
      if (static_cast<unsigned>(cx) < static_cast<unsigned>(level.width) &&
          static_cast<unsigned>(cy) < static_cast<unsigned>(level.height))
        total += level.values[static_cast<std::size_t>(cy * level.width + cx)];
    }
    return total;
  }
  Pose2 pose(const Block& b) const {
    return {window.centre.x + b.x * m.resolution_, window.centre.y + b.y * m.resolution_,
            wrap_angle(headings[static_cast<std::size_t>(b.heading)])};
  }
  bool is_excluded(const Pose2& p) const {
    return excluded && std::hypot(p.x - excluded->x, p.y - excluded->y) < kApartM &&
           std::abs(wrap_angle(p.theta - excluded->theta)) < kApartRad;
  }
  void descend(std::vector<Block> blocks, std::size_t h) {
    // Best first; equal bounds keep the order of the lattice, so that the result is one and the same everywhere.
    std::stable_sort(blocks.begin(), blocks.end(), [](const Block& a, const Block& b) { return a.sum > b.sum; });
    for (const Block& b : blocks) {
      if (b.sum <= best_sum) return;
      if (h == 0) {
        if (is_excluded(pose(b))) continue;
        best_sum = b.sum;
        best = pose(b);
        return;
      }
      const Level& level = m.levels_[h - 1];
      std::vector<Block> children;
      for (const int y : {b.y, b.y + level.span})
        for (const int x : {b.x, b.x + level.span}) {
          if (x > shifts || y > shifts) continue;
          long bound = sum(level, turned[static_cast<std::size_t>(b.heading)], x, y) - doubt_of_heading(b.heading);
          if (h == 1) bound -= doubt_of_shift(x, y);
          if (bound > best_sum) children.push_back({b.heading, x, y, bound});
        }
      descend(std::move(children), h - 1);
    }
  }
};

std::optional<SearchHit> CorrelativeMatcher::best(std::span<const SurfacePoint> scan, const SearchWindow& window,
                                                  double least_score, const std::optional<Pose2>& excluded) const {
  if (levels_.empty() || scan.empty()) return std::nullopt;
  std::vector<double> reaches;
  for (const auto& q : scan) reaches.push_back(std::hypot(q.p.x, q.p.y));
  std::sort(reaches.begin(), reaches.end());
  const double far = std::max(1.0, reaches[reaches.size() * 3 / 4]);
  const double step = std::clamp(resolution_ / far, kLeastTurn, kMostTurn);
  const auto turns = static_cast<int>(std::ceil(window.turn_rad / step));
  const double perfect = 255.0 * static_cast<double>(scan.size());
  Search search{*this, window, excluded, static_cast<int>(std::ceil(window.shift_m / resolution_)), {}, {},
                perfect, static_cast<long>(least_score * perfect), std::nullopt};
  std::vector<Search::Block> blocks;
  const Level& top = levels_.back();
  for (int k = -turns; k <= turns; ++k) {
    const double theta = window.centre.theta + window.turn_rad * k / std::max(turns, 1);
    search.headings.push_back(theta);
    std::vector<CellOffset> points;
    points.reserve(scan.size());
    for (const auto& q : scan) {
      const Point p = Pose2{window.centre.x, window.centre.y, theta} * q.p;
      points.push_back({static_cast<int>(std::floor((p.x - origin_.x) / resolution_)),
                        static_cast<int>(std::floor((p.y - origin_.y) / resolution_))});
    }
    search.turned.push_back(std::move(points));
    for (int y = -search.shifts; y <= search.shifts; y += top.span)
      for (int x = -search.shifts; x <= search.shifts; x += top.span) {
        long bound = search.sum(top, search.turned.back(), x, y) - search.doubt_of_heading(k + turns);
        if (top.span == 1) bound -= search.doubt_of_shift(x, y);
        if (bound > search.best_sum) blocks.push_back({k + turns, x, y, bound});
      }
  }
  search.descend(std::move(blocks), levels_.size() - 1);
  if (!search.best) return std::nullopt;
  return SearchHit{*search.best, static_cast<double>(search.best_sum) / perfect};
}

}  // namespace outrider::slam_glue
