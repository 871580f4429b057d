#include "slam_glue/correlative.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace outrider::slam_glue {
namespace {

constexpr double kLeastBlur = 0.08;   // standard deviation of the nearness [m]; at least a cell
constexpr double kLeastTurn = 0.005;  // finest step in heading [rad]
constexpr double kMostTurn = 0.03;
constexpr double kDoubt = 0.01;  // of the score, per squared standard deviation from the centre

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
  // Squared distances first: one exponential a cell instead of one a point and cell.
  const double cells_a_blur = resolution_ / blur;
  constexpr float kFar = std::numeric_limits<float>::max();
  std::vector<float> squared(base.values.size(), kFar);
  for (const auto& q : map) {
    const double fx = (q.p.x - origin_.x) / resolution_, fy = (q.p.y - origin_.y) / resolution_;
    const int cx = static_cast<int>(fx), cy = static_cast<int>(fy);
    for (int y = cy - reach; y <= cy + reach; ++y) {
      float* row = &squared[static_cast<std::size_t>(y * width_)];
      const double dy = y + 0.5 - fy;
      for (int x = cx - reach; x <= cx + reach; ++x) {
        const double dx = x + 0.5 - fx;
        row[x] = std::min(row[x], static_cast<float>(dx * dx + dy * dy));
      }
    }
  }
  for (std::size_t i = 0; i < squared.size(); ++i)
    if (squared[i] < kFar)
      base.values[i] = static_cast<std::uint8_t>(
          255.0 * std::exp(-0.5 * cells_a_blur * cells_a_blur * static_cast<double>(squared[i])));
  levels_.push_back(std::move(base));
  while (static_cast<int>(levels_.size()) < levels) levels_.push_back(maxima_above(levels_.back()));
}

/// Maxima over twice the span: of two neighbours in x, then of two in y.
CorrelativeMatcher::Level CorrelativeMatcher::maxima_above(const Level& below) {
  Level level{2 * below.span, {}, below.width + below.span, below.height + below.span};
  const auto span = static_cast<std::size_t>(below.span), width = static_cast<std::size_t>(level.width);
  const auto below_width = static_cast<std::size_t>(below.width), below_height = static_cast<std::size_t>(below.height);
  level.values.assign(width * static_cast<std::size_t>(level.height), 0);
  std::vector<std::uint8_t> row(width);
  for (std::size_t y = 0; y < below_height; ++y) {
    const std::uint8_t* from = &below.values[y * below_width];
    std::fill(row.begin(), row.end(), std::uint8_t{0});
    std::copy(from, from + below_width, row.begin());
    for (std::size_t x = 0; x < below_width; ++x) row[x + span] = std::max(row[x + span], from[x]);
    for (const std::size_t to : {y, y + span}) {
      std::uint8_t* out = &level.values[to * width];
      for (std::size_t x = 0; x < width; ++x) out[x] = std::max(out[x], row[x]);
    }
  }
  return level;
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
  Search search{*this,       window, excluded, static_cast<int>(std::ceil(window.shift_m / resolution_)),
                {},          {},     perfect,  static_cast<long>(least_score * perfect),
                std::nullopt};
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
