#pragma once
// Exact first contact of a point that moves along a straight line. A disc that meets a square is a point that meets the
// square grown by the disc's radius; a disc that meets a disc is a point that meets a disc of both radii.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "world/geometry.hpp"

namespace outrider::sim {

/// Touching is legal. Bodies stop kStopDepth inside the touching distance at most, so that a body at rest against a
/// wall is not caught by rounding; the check after every step allows kTouchTolerance.
inline constexpr double kStopDepth = 5e-10;      ///< [m]
inline constexpr double kTouchTolerance = 1e-9;  ///< [m]
inline constexpr double kNever = std::numeric_limits<double>::infinity();

/// The straight way from a point along a unit vector.
struct Sweep {
  Point from;
  double dx = 1.0, dy = 0.0;
  Point at(double length) const { return {from.x + length * dx, from.y + length * dy}; }
};

/// An axis-aligned rectangle [m].
struct Box {
  double x0, y0, x1, y1;
  Point nearest(Point p) const { return {std::clamp(p.x, x0, x1), std::clamp(p.y, y0, y1)}; }
};

/// Length [m] at which the way enters the open disc; kNever if it does not. A way that begins inside enters at 0,
/// unless it leads away from the centre: a body pressed against something by rounding may leave.
inline double entry_into_disc(const Sweep& s, Point center, double radius) {
  const double mx = center.x - s.from.x, my = center.y - s.from.y;
  const double along = mx * s.dx + my * s.dy;
  const double across = mx * s.dy - my * s.dx;
  if (along <= 0.0 || std::abs(across) >= radius) return kNever;
  return std::max(0.0, along - std::sqrt(radius * radius - across * across));
}

/// Length [m] at which the way enters the interior of the box; kNever if it does not or begins inside.
inline double entry_into_box(const Sweep& s, const Box& box) {
  double enter = -kNever, leave = kNever;
  const auto slab = [&](double from, double d, double low, double high) {
    if (d == 0.0) {
      if (from <= low || from >= high) leave = -kNever;
      return;
    }
    const double a = (low - from) / d, b = (high - from) / d;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  };
  slab(s.from.x, s.dx, box.x0, box.x1);
  slab(s.from.y, s.dy, box.y0, box.y1);
  return enter < leave && enter >= 0.0 ? enter : kNever;
}

/// Length [m] at which the way comes nearer than `radius` to the box; kNever if it does not. A way that begins nearer
/// is stopped at 0, unless it leads away. The distance to a convex shape is convex along a line, so a way that leads
/// away at its beginning leads away for ever.
inline double entry_into_grown_box(const Sweep& s, const Box& box, double radius) {
  const Point near = box.nearest(s.from);
  const double rx = s.from.x - near.x, ry = s.from.y - near.y;
  const double gap = rx * rx + ry * ry;
  if (gap < radius * radius) return gap > 0.0 && rx * s.dx + ry * s.dy >= 0.0 ? kNever : 0.0;
  double first = std::min(entry_into_box(s, {box.x0 - radius, box.y0, box.x1 + radius, box.y1}),
                          entry_into_box(s, {box.x0, box.y0 - radius, box.x1, box.y1 + radius}));
  for (const Point corner :
       {Point{box.x0, box.y0}, Point{box.x1, box.y0}, Point{box.x0, box.y1}, Point{box.x1, box.y1}})
    first = std::min(first, entry_into_disc(s, corner, radius));
  return first;
}

}  // namespace outrider::sim
