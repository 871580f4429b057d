#include "link/radio.hpp"

#include <algorithm>

#include "world/ray.hpp"

namespace outrider::link {
namespace {

constexpr std::uint64_t kBreakStream = 0x9E3779B97F4A7C15U, kLossStream = 0xD1B54A32D192ED03U;

/// In [0, 1), the same on every platform.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }

bool named(const std::vector<RobotId>& robots, RobotId robot) {
  return std::binary_search(robots.begin(), robots.end(), robot);
}

}  // namespace

bool Break::cuts(RobotId from, RobotId to, double t) const {
  if (t < begin_s || t >= end_s) return false;
  if (kind == Kind::kSplit) return named(robots, from) != named(robots, to);
  return robots.empty() || named(robots, from) || named(robots, to);
}

std::vector<Break> schedule(const RadioSpec& spec, double horizon_s) {
  std::vector<double> lengths;
  double within = 0.0, sum = 0.0;
  for (const RandomBreaks& r : spec.random_breaks) {
    lengths.insert(lengths.end(), static_cast<std::size_t>(r.count), r.seconds);
    sum += r.count * r.seconds;
    within = std::max(within, r.within_s);
  }
  if (within == 0.0) within = std::max(horizon_s, 2.0 * sum);
  std::mt19937_64 random(spec.seed ^ kBreakStream);
  for (std::size_t i = lengths.size(); i > 1; --i)
    std::swap(lengths[i - 1], lengths[static_cast<std::size_t>(uniform(random) * static_cast<double>(i))]);
  // N sorted uniform numbers in what is left of the horizon are the gaps: all placements are equally likely.
  std::vector<double> at(lengths.size());
  for (double& t : at) t = uniform(random) * std::max(0.0, within - sum);
  std::sort(at.begin(), at.end());
  std::vector<Break> breaks = spec.breaks;
  double before = 0.0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    breaks.push_back({Break::Kind::kSilence, at[i] + before, at[i] + before + lengths[i], {}});
    before += lengths[i];
  }
  for (Break& b : breaks) std::sort(b.robots.begin(), b.robots.end());
  std::stable_sort(breaks.begin(), breaks.end(), [](const Break& a, const Break& b) { return a.begin_s < b.begin_s; });
  return breaks;
}

Radio::Radio(const RadioSpec& spec, double horizon_s, const OccupancyGrid& truth, Where where)
    : spec_(spec), truth_(truth), where_(std::move(where)), breaks_(schedule(spec, horizon_s)),
      random_(spec.seed ^ kLossStream) {}

std::optional<double> Radio::operator()(RobotId from, RobotId to, double now_s) {
  if (spec_.none || cut(from, to, now_s) || cut(from, to, now_s + spec_.delay_s) || !in_reach(from, to))
    return std::nullopt;
  if (spec_.loss > 0.0 && uniform(random_) < spec_.loss) return std::nullopt;
  return spec_.delay_s;
}

void Radio::set_deaf(RobotId robot, bool deaf) {
  std::erase(deaf_, robot);
  if (deaf) deaf_.push_back(robot);
}

bool Radio::cut(RobotId from, RobotId to, double t) const {
  return std::find(deaf_.begin(), deaf_.end(), to) != deaf_.end() ||
         std::any_of(breaks_.begin(), breaks_.end(), [&](const Break& b) { return b.cuts(from, to, t); });
}

bool Radio::in_reach(RobotId from, RobotId to) const {
  if (!spec_.range_m && !spec_.line_of_sight) return true;
  const Point a = where_(from), b = where_(to);
  if (spec_.range_m && distance(a, b) > *spec_.range_m) return false;
  const auto& g = truth_.geometry();
  return !spec_.line_of_sight || line_of_sight(truth_, g.cell_of(a), g.cell_of(b));
}

}  // namespace outrider::link
