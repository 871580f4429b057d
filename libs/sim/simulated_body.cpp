#include "sim/simulated_body.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace outrider::sim {

const Sensing& SimulatedBody::sense() {
  delivered_.cells.clear();
  delivered_.scans.clear();
  std::swap(delivered_.cells, gathering.cells);
  std::swap(delivered_.scans, gathering.scans);
  delivered_.pose = pose;
  delivered_.sightings.clear();
  if (alive) delivered_.sightings = sightings_in_view_();
  delivered_.arrived = arrived();
  delivered_.blocked = blocked;
  return delivered_;
}

void SimulatedBody::follow(std::span<const Point> way_points) {
  assert(std::all_of(way_points.begin(), way_points.end(),
                     [](Point p) { return std::isfinite(p.x) && std::isfinite(p.y); }));
  way_points_.clear();
  next_ = 0;
  leg_.reset();
  blocked = false;
  if (alive) way_points_.assign(way_points.begin(), way_points.end());
}

SimulatedBody::Leg* SimulatedBody::leg() {
  while (!leg_ && !arrived()) {
    const Point from = pose.position(), to = way_points_[next_];
    const double length = distance(from, to);
    if (length > 0.0) {
      leg_ = Leg{{from, (to.x - from.x) / length, (to.y - from.y) / length}, length, walls.free_length(from, to), 0.0};
      pose.theta = std::atan2(to.y - from.y, to.x - from.x);
    } else {
      ++next_;
    }
  }
  return leg_ ? &*leg_ : nullptr;
}

void SimulatedBody::drive_to(double driven) {
  assert(leg_);
  path_m += driven - leg_->driven;
  leg_->driven = driven;
  const bool done = driven >= leg_->length;
  const Point p = done ? way_points_[next_] : leg_->way.at(driven);
  pose.x = p.x;
  pose.y = p.y;
  if (!done) return;
  leg_.reset();
  ++next_;
}

}  // namespace outrider::sim
