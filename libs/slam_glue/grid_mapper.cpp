#include "slam_glue/grid_mapper.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "slam_glue/mrpt_grid.hpp"
#include "world/ray.hpp"

namespace outrider::slam_glue {
namespace {

/// Longer rays are cut, so that cell coordinates fit into an int [cells].
constexpr double kMostCells = 1e6;

/// A beam in the map frame.
struct Ray {
  double dx = 0.0, dy = 0.0;  ///< unit vector
  double length = 0.0;        ///< [m], to the echo or to where the beam clears
  Cell end;                   ///< the cell of the echo, or the last cell that the beam clears
  bool echo = false;
};

/// How far an echo is pushed into the wall [m]: ranges are floats, and a noiseless lidar returns the wall's very face.
double into_wall(double range, double resolution) { return 2.4e-7 * range + 1e-5 * resolution; }

/// What the current scan says of a cell.
enum Mark : std::uint8_t { kNothing = 0, kMiss = 1, kHit = 2 };

}  // namespace

struct GridMapper::Impl {
  Impl(const GridGeometry& geometry, const MapperOptions& o)
      : options(o), states(geometry), grid(geometry), cells(grid.cells()), marks(geometry, kNothing) {}

  bool make_ray(const LaserScan& scan, std::size_t beam, const Pose2& T_map_sensor, Ray& ray) const;
  void mark_along(const Ray& ray, Point from, Cell start);
  void apply_marks(Cell low, Cell high, std::vector<std::uint32_t>& changed);
  bool apply_block(std::size_t begin, std::size_t count);
  void note_changes(std::size_t begin, std::size_t end, std::vector<std::uint32_t>& changed);
  bool well_inside(Cell c) const { return c.x > 0 && c.y > 0 && c.x + 1 < states.width() && c.y + 1 < states.height(); }

  MapperOptions options;
  OccupancyGrid states;
  MrptGrid grid;
  std::int8_t* cells;        ///< of `grid`, row-major
  Grid<std::uint8_t> marks;  ///< all kNothing between two scans
  std::vector<Ray> rays;
};

bool GridMapper::Impl::make_ray(const LaserScan& scan, std::size_t beam, const Pose2& T_map_sensor, Ray& ray) const {
  const double range = scan.ranges[beam];
  if (range <= 0.0) return false;  // a fault of the sensor, no statement about the world
  ray.echo = scan.valid(beam) && range <= options.max_range_m;
  if (ray.echo)
    ray.length = range;
  else if (scan.valid(beam))
    ray.length = options.max_range_m;
  else
    ray.length = std::min({options.no_echo_range_m, options.max_range_m, scan.range_max});
  if (!(ray.length > 0.0)) return false;
  const double farthest = kMostCells * states.geometry().resolution;
  ray.echo = ray.echo && ray.length <= farthest;
  ray.length = std::min(ray.length, farthest);
  const double angle = T_map_sensor.theta + scan.angle(beam);
  ray.dx = std::cos(angle);
  ray.dy = std::sin(angle);
  const GridGeometry& g = states.geometry();
  const auto cell_at = [&](double way) { return g.cell_of({T_map_sensor.x + way * ray.dx, T_map_sensor.y + way * ray.dy}); };
  if (ray.echo) {
    const double into = into_wall(ray.length, g.resolution);
    const Cell front = cell_at(ray.length - into);
    ray.end = cell_at(ray.length + into);
    ray.echo = front.x == ray.end.x || front.y == ray.end.y;  // else a corner: of one of the two cells beside
    if (ray.echo) return true;
    ray.length -= into;
  }
  ray.end = cell_at(ray.length);
  return true;
}

/// Marks the cells from `start` up to `ray.end` as missed (an echo's own cell too: its hit is marked later). Amanatides
/// and Woo's traversal in fixed point: the sign of `lead` is that of t_x - t_y, so a step needs no branch.
void GridMapper::Impl::mark_along(const Ray& ray, Point from, Cell start) {
  const GridGeometry& g = states.geometry();
  // Within the outermost ring of cells, one step too many (from rounding at a corner) is still inside the grid.
  if (!well_inside(start) || !well_inside(ray.end)) {
    walk_ray(g, from, ray.dx, ray.dy, ray.length, [&](Cell c, double) {
      marks[c] = kMiss;
      return true;
    });
    return;
  }
  constexpr double kOne = 1LL << 40;
  const double fraction_x = (from.x - g.origin.x) / g.resolution - start.x;
  const double fraction_y = (from.y - g.origin.y) / g.resolution - start.y;
  const double to_x = ray.dx > 0 ? 1.0 - fraction_x : fraction_x, to_y = ray.dy > 0 ? 1.0 - fraction_y : fraction_y;
  const auto dx = static_cast<std::int64_t>(std::abs(ray.dx) * kOne);
  const auto dy = static_cast<std::int64_t>(std::abs(ray.dy) * kOne);
  // t_x <= t_y <=> to_x / |dx| <= to_y / |dy| <=> to_x |dy| - to_y |dx| <= 0; a step in x adds |dy|, in y takes |dx|.
  auto lead = static_cast<std::int64_t>((to_x * std::abs(ray.dy) - to_y * std::abs(ray.dx)) * kOne) - 1;
  const std::int64_t step_y = ray.dy > 0 ? g.width : -g.width, x_not_y = (ray.dx > 0 ? 1 : -1) - step_y;
  std::uint8_t* mark = marks.data().data() + g.index(start);
  *mark = kMiss;
  for (int i = std::abs(ray.end.x - start.x) + std::abs(ray.end.y - start.y); i > 0; --i) {
    const std::int64_t in_x = lead >> 63;  // all ones when the next border is one in x
    lead += (in_x & (dx + dy)) - dx;
    mark += step_y + (in_x & x_not_y);
    *mark = kMiss;
  }
}

/// Adds the marks to the log-odds and clears them; true when the state of a cell in the block no longer fits.
/// Selections on bytes only, so that the compiler turns it into vector instructions.
inline bool GridMapper::Impl::apply_block(std::size_t begin, std::size_t count) {
  const auto hit = static_cast<std::int8_t>(options.hit), miss = static_cast<std::int8_t>(options.miss);
  const auto top = static_cast<std::int8_t>(127 - miss), bottom = static_cast<std::int8_t>(hit - 127);
  std::uint8_t* __restrict mark = marks.data().data() + begin;
  std::int8_t* __restrict cell = cells + begin;
  const auto* __restrict state = reinterpret_cast<const std::uint8_t*>(states.data().data()) + begin;
  std::uint8_t differs = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::int8_t odds = cell[i];
    std::int8_t freer = odds > top ? std::int8_t{127} : static_cast<std::int8_t>(odds + miss);
    std::int8_t fuller = odds < bottom ? std::int8_t{-127} : static_cast<std::int8_t>(odds - hit);
    freer = freer == 0 ? std::int8_t{1} : freer;  // what is known stays known
    fuller = fuller == 0 ? std::int8_t{-1} : fuller;
    const std::int8_t updated = mark[i] == kMiss ? freer : mark[i] == kHit ? fuller : odds;
    const std::uint8_t fits = updated > 0 ? std::uint8_t{1} : updated < 0 ? std::uint8_t{2} : std::uint8_t{0};
    differs = static_cast<std::uint8_t>(differs | (fits ^ state[i]));
    cell[i] = updated;
    mark[i] = kNothing;
  }
  return differs != 0;
}

void GridMapper::Impl::note_changes(std::size_t begin, std::size_t end, std::vector<std::uint32_t>& changed) {
  for (std::size_t i = begin; i < end; ++i) {
    const CellState state = cells[i] > 0 ? CellState::kFree : cells[i] < 0 ? CellState::kOccupied : CellState::kUnknown;
    if (states[i] == state) continue;
    states[i] = state;
    changed.push_back(static_cast<std::uint32_t>(i));
  }
}

void GridMapper::Impl::apply_marks(Cell low, Cell high, std::vector<std::uint32_t>& changed) {
  constexpr std::size_t kBlock = 32;
  for (int y = low.y; y <= high.y; ++y) {
    const std::size_t end = states.geometry().index({high.x, y}) + 1;
    std::size_t i = states.geometry().index({low.x, y});
    for (; i + kBlock <= end; i += kBlock) {
      std::array<std::uint64_t, kBlock / 8> words;
      std::memcpy(words.data(), marks.data().data() + i, kBlock);
      if ((words[0] | words[1] | words[2] | words[3]) == 0) continue;  // most of the box lies behind walls
      if (apply_block(i, kBlock)) note_changes(i, i + kBlock, changed);
    }
    if (i < end && apply_block(i, end - i)) note_changes(i, end, changed);
  }
}

GridMapper::GridMapper(const GridGeometry& geometry, const MapperOptions& options)
    : impl_(std::make_unique<Impl>(geometry, options)) {}
GridMapper::~GridMapper() = default;
GridMapper::GridMapper(GridMapper&&) noexcept = default;
GridMapper& GridMapper::operator=(GridMapper&&) noexcept = default;

void GridMapper::insert(const LaserScan& scan, const Pose2& T_map_robot, std::vector<std::uint32_t>& changed) {
  Impl& m = *impl_;
  const Pose2 T_map_sensor = T_map_robot * scan.T_robot_sensor;
  const GridGeometry& g = m.states.geometry();
  const Point from = T_map_sensor.position();
  const Cell start = g.cell_of(from);
  Cell low = start, high = start;  // of all marks
  m.rays.clear();
  Ray ray;
  for (std::size_t beam = 0; beam < scan.ranges.size(); ++beam) {
    if (!m.make_ray(scan, beam, T_map_sensor, ray)) continue;
    m.mark_along(ray, from, start);
    m.rays.push_back(ray);
    low = {std::min(low.x, ray.end.x), std::min(low.y, ray.end.y)};
    high = {std::max(high.x, ray.end.x), std::max(high.y, ray.end.y)};
  }
  for (const Ray& r : m.rays)  // last: a hit wins over the misses of the same scan
    if (r.echo && g.contains(r.end)) m.marks[r.end] = kHit;
  low = {std::max(low.x - 1, 0), std::max(low.y - 1, 0)};  // one more, for a rounded step
  high = {std::min(high.x + 1, g.width - 1), std::min(high.y + 1, g.height - 1)};
  if (low.x <= high.x && low.y <= high.y) m.apply_marks(low, high, changed);
}

const OccupancyGrid& GridMapper::states() const { return impl_->states; }

void GridMapper::save(const std::filesystem::path& gridmap) const { impl_->grid.save(gridmap); }

}  // namespace outrider::slam_glue
