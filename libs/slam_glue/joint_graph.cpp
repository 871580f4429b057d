#include "slam_glue/joint_graph.hpp"

#include <algorithm>
#include <cmath>

namespace outrider::slam_glue {
namespace {

constexpr double kKeyframeM = 0.5, kKeyframeRad = 0.5;
constexpr double kStepM = 0.01, kStepRad = 0.005, kPerMetre = 0.02;  // what a foreign trajectory errs in a step

Pose2 blend(const Pose2& a, const Pose2& b, double s) {
  return {a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), wrap_angle(a.theta + s * wrap_angle(b.theta - a.theta))};
}

}  // namespace

SessionGraph session_graph(const LogReader& reader, std::span<const TimedPose> trajectory, double max_range_m) {
  SessionGraph session;
  KeyframeGraph& g = session.graph;
  std::size_t i = 0;
  double path_m = 0.0;
  reader.read([&](const LogEntry& entry, double) {
    const Pose2& pose = trajectory[i].pose;
    if (i > 0) path_m += distance(trajectory[i - 1].pose.position(), pose.position());
    const Pose2 T = g.size() == 0 ? Pose2{} : inverse(g.poses.back()) * pose;
    const double way = std::hypot(T.x, T.y);
    if (g.size() == 0 || way > kKeyframeM || std::abs(T.theta) > kKeyframeRad) {
      const double m = kStepM + kPerMetre * way, rad = kStepRad + kPerMetre * (way + std::abs(T.theta));
      const Eigen::Vector3d information{1.0 / (m * m), 1.0 / (m * m), 1.0 / (rad * rad)};
      if (g.size() > 0) g.edges.push_back({g.size() - 1, g.size(), T, information.asDiagonal().toDenseMatrix(), false});
      g.frames.push_back(make_keyframe(entry.scan, max_range_m));
      g.frames.back().index = i;
      g.frames.back().path_m = path_m;
      g.poses.push_back(pose);
    }
    return ++i < trajectory.size();
  });
  return session;
}

JointGraph::JointGraph(std::vector<SessionGraph> sessions) {
  for (std::size_t s = 0; s < sessions.size(); ++s) {
    SessionGraph& session = sessions[s];
    const std::size_t first = graph.size();
    begin.push_back(first);
    for (Keyframe& frame : session.graph.frames) {
      frame.session = s;
      graph.frames.push_back(std::move(frame));
    }
    graph.poses.insert(graph.poses.end(), session.graph.poses.begin(), session.graph.poses.end());
    for (PoseEdge e : session.graph.edges) {
      e.from += first, e.to += first;
      graph.edges.push_back(e);
    }
    for (LoopClosure c : session.closures) {
      c.from += first, c.to += first;
      closures.push_back(c);
    }
    session = {};
  }
  begin.push_back(graph.size());
}

void JointGraph::move(std::size_t session, const Pose2& T_new_old) {
  for (std::size_t i = begin[session]; i < begin[session + 1]; ++i) graph.poses[i] = T_new_old * graph.poses[i];
}

void JointGraph::carry(std::size_t session, std::span<const Pose2> before, std::span<TimedPose> trajectory) const {
  std::size_t k = begin[session];
  const auto now = std::span(graph.poses).subspan(k, begin[session + 1] - k);
  if (std::equal(now.begin(), now.end(), before.begin() + static_cast<std::ptrdiff_t>(k))) return;
  const std::size_t last = begin[session + 1] - 1;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    while (k < last && graph.frames[k + 1].index <= i) ++k;
    const std::size_t next = std::min(k + 1, last);
    const Pose2 from_k = graph.poses[k] * (inverse(before[k]) * trajectory[i].pose);
    const Pose2 from_next = graph.poses[next] * (inverse(before[next]) * trajectory[i].pose);
    const std::size_t a = graph.frames[k].index, b = graph.frames[next].index;
    const double s = b > a ? std::clamp(static_cast<double>(i - a) / static_cast<double>(b - a), 0.0, 1.0) : 0.0;
    trajectory[i].pose = blend(from_k, from_next, s);
  }
}

}  // namespace outrider::slam_glue
