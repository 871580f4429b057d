#include "slam_glue/graph_slam.hpp"

#include <algorithm>
#include <cmath>

#include "slam_glue/localizer.hpp"

namespace outrider::slam_glue {
namespace {

constexpr double kStillM = 2e-3, kStillRad = 2e-3;  // wheels that moved less have not moved
constexpr double kLost = 0.35;                      // a smaller share of matching points says nothing about the pose,
constexpr double kLostOfUsual = 0.6;                // or a smaller share of what is usual, where ranges are noisy
constexpr double kBlindM = 0.1, kBlindRad = 0.12;   // least error of wheels where nothing matches
constexpr double kNoWheelsBlindM = 0.5, kNoWheelsBlindRad = 0.6;  // without wheels
constexpr int kAstray = 3;      // scans in a row that match nothing: without wheels a new beginning
constexpr double kDoubt = 0.9;  // of the usual share: below, the start of the match may have been wrong
constexpr double kNearM = 0.15, kNearRad = 0.1;           // how far off a start may be for the match to recover
constexpr double kNoWheelsM = 0.15, kNoWheelsRad = 0.15;  // of the guess that the motion goes on [m, rad]

double magnitude(const Pose2& T) { return std::hypot(T.x, T.y); }
double way_of(const Pose2& move) { return magnitude(move) + 0.1 * std::abs(move.theta); }
double turn_of(const Pose2& move) { return std::abs(move.theta) + 0.1 * magnitude(move); }

Eigen::Matrix3d information_of(const WheelNoise::Variance& v) {
  return Eigen::Vector3d(1.0 / v.shift, 1.0 / v.shift, 1.0 / v.turn).asDiagonal().toDenseMatrix();
}

/// Share of matching points, less what the wheels say against the pose.
double worth(const PointMatch& match, const Pose2& guess, const WheelNoise::Variance& doubt) {
  constexpr double kCost = 0.01;  // per squared standard deviation
  const double shift = magnitude(inverse(guess) * match.T_map_robot);
  const double turn = wrap_angle(match.T_map_robot.theta - guess.theta);
  return match.share - kCost * (shift * shift / doubt.shift + turn * turn / doubt.turn);
}

}  // namespace

WheelNoise::Variance WheelNoise::of(const Pose2& move) const {
  constexpr double kLeast = 1e-3;  // wheels are read in steps [m, rad]
  return {shift_ * way_of(move) + kLeast * kLeast, turn_ * turn_of(move) + kLeast * kLeast};
}

void WheelNoise::learn(const Pose2& move, const Pose2& matched) {
  constexpr double kRate = 0.1, kLeastShift = 2e-4, kLeastTurn = 2e-4, kMostShift = 0.05, kMostTurn = 0.3;
  constexpr double kOutlier = 9.0;  // squared standard deviations
  const double way = way_of(move), turn = turn_of(move);
  if (way < 0.01) return;
  const Pose2 error = inverse(move) * matched;
  const double shift_seen = 0.5 * (error.x * error.x + error.y * error.y) / way;
  const double turn_seen = error.theta * error.theta / turn;
  shift_ += kRate * (std::min(shift_seen, kOutlier * shift_) - shift_);
  turn_ += kRate * (std::min(turn_seen, kOutlier * turn_) - turn_);
  shift_ = std::clamp(shift_, kLeastShift, kMostShift);
  turn_ = std::clamp(turn_, kLeastTurn, kMostTurn);
}

double GraphSlam::lost_share() const { return std::min(kLost, kLostOfUsual * usual_share_); }

PointMatch GraphSlam::locate(const std::vector<SurfacePoint>& points, const Pose2& guess,
                             const WheelNoise::Variance& doubt) {
  const PosePrior prior{guess, information_of(doubt)};
  const PointMatch match = match_points(*local_, points, guess, noise_m_, prior);
  const double shift = 3.0 * std::sqrt(doubt.shift), turn = 3.0 * std::sqrt(doubt.turn);
  const bool vague = shift > kNearM || turn > kNearRad;
  if (!vague && match.share >= kDoubt * usual_share_) return match;
  constexpr double kReach = 12.0;  // farther points are too sparse to search with [m]
  if (!local_search_) local_search_.emplace(within(local_points_, {}, kReach + 1.0), 0.05, 4);
  const SearchWindow window{guess, std::clamp(shift, 0.3, 1.0), std::clamp(turn, 0.2, 0.8), std::sqrt(doubt.shift),
                            std::sqrt(doubt.turn)};
  const auto hit = local_search_->best(thinned(within(points, {}, kReach), 0.1), window, 0.2);
  PointMatch best = match;
  if (hit) {
    const PointMatch other = match_points(*local_, points, hit->T_map_robot, noise_m_, prior);
    constexpr double kClearly = 0.02;
    if (worth(other, guess, doubt) > worth(match, guess, doubt) + kClearly) best = other;
  }
  return has_wheels_ || best.share > lost_share() ? best : locate_anywhere(points, guess).value_or(best);
}

/// Without wheels a robot that turns quickly, or a gap in the log, leaves any guess behind.
std::optional<PointMatch> GraphSlam::locate_anywhere(const std::vector<SurfacePoint>& points,
                                                     const Pose2& guess) const {
  constexpr double kShiftM = 1.0, kTurnRad = 1.6, kSure = 0.7;
  const auto hit = local_search_->best(thinned(points, 0.1), {guess, kShiftM, kTurnRad}, 0.3);
  if (!hit) return std::nullopt;
  const PointMatch match = match_points(*local_, points, hit->T_map_robot, noise_m_);
  if (match.share < kSure * usual_share_) return std::nullopt;
  return match;
}

Pose2 GraphSlam::add(const LaserScan& scan, const Pose2& odometry) {
  Keyframe frame = make_keyframe(scan, settings_.max_range_m);
  frame.index = scans_.size();
  if (graph_.size() == 0) {
    odometry_ = odometry;
    graph_.frames.push_back(std::move(frame));
    graph_.poses.push_back({});
    scans_.push_back({0, {}});
    rebuild_local_map();
    return graph_.poses.back();
  }
  Pose2 move = inverse(*odometry_) * odometry;
  odometry_ = odometry;
  const bool moved = magnitude(move) > kStillM || std::abs(move.theta) > kStillRad;
  has_wheels_ = has_wheels_ || moved;
  WheelNoise::Variance doubt = wheels_.of(move);
  if (!has_wheels_) {
    move = velocity_;
    doubt = {kNoWheelsM * kNoWheelsM, kNoWheelsRad * kNoWheelsRad};
  }
  const std::size_t last = graph_.size() - 1;
  const Tracked before = scans_.back().keyframe == last
                             ? scans_.back()
                             : Tracked{last, inverse(graph_.poses[last]) * graph_.poses[scans_.back().keyframe] *
                                                 scans_.back().T_keyframe_robot};
  const Pose2 guess = before.T_keyframe_robot * move;
  const PointMatch match = locate(frame.points, guess, doubt);
  const bool found = match.share > lost_share();
  const Pose2 T = found ? match.T_map_robot : has_wheels_ ? guess : before.T_keyframe_robot;
  const Pose2 matched = inverse(before.T_keyframe_robot) * T;
  T_keyframe_wheels_ = T_keyframe_wheels_ * move;
  way_ = {way_.shift + doubt.shift, way_.turn + doubt.turn};
  if (found) {
    usual_share_ += 0.05 * (match.share - usual_share_);
    noise_m_ += 0.02 * (std::clamp(match.rms_m, 0.015, 0.1) - noise_m_);
    velocity_ = matched;
    misses_ = 0;
  } else {
    velocity_ = {};
    ++misses_;
  }
  path_m_ += magnitude(matched);
  frame.path_m = path_m_;
  scans_.push_back({last, T});
  const bool far = magnitude(T) > settings_.keyframe_m || std::abs(T.theta) > settings_.keyframe_rad;
  const bool thinning = match.share < 0.7 * usual_share_ && magnitude(T) > 0.3 * settings_.keyframe_m;
  const bool astray = !has_wheels_ && misses_ >= kAstray;
  if (far || thinning || astray) {
    if (!found) {
      const double m = has_wheels_ ? kBlindM : kNoWheelsBlindM, rad = has_wheels_ ? kBlindRad : kNoWheelsBlindRad;
      way_ = {std::max(way_.shift, m * m), std::max(way_.turn, rad * rad)};
    }
    Eigen::Matrix3d information = information_of(way_);
    if (found) information += match.information;
    if (found && has_wheels_ && match.bound) wheels_.learn(T_keyframe_wheels_, match.T_scan_only);
    add_keyframe(std::move(frame), T, information, !found);
  }
  return graph_.poses[scans_.back().keyframe] * scans_.back().T_keyframe_robot;
}

void GraphSlam::add_keyframe(Keyframe frame, const Pose2& T_last_frame, const Eigen::Matrix3d& information,
                             bool blind) {
  const std::size_t k = graph_.size();
  graph_.edges.push_back({k - 1, k, T_last_frame, information, false, blind});
  misses_ = 0;
  steps_.push_back(T_last_frame);
  graph_.poses.push_back(graph_.poses[k - 1] * T_last_frame);
  graph_.frames.push_back(std::move(frame));
  scans_.back() = {k, {}};
  way_ = {0.0, 0.0};
  T_keyframe_wheels_ = {};
  if (closer_.look(graph_, k)) closer_.optimise(graph_);
  // What leaves the local map is kept only where it shows something new: memory grows with the place, not with the log.
  if (k >= settings_.recent && closer_.shown_before(graph_, k - settings_.recent))
    graph_.frames[k - settings_.recent].forget();
  rebuild_local_map();
}

void GraphSlam::rebuild_local_map() {
  const std::size_t k = graph_.size() - 1;
  const auto [begin, end] = graph_.neighbours(k, settings_.recent - 1, 0);
  local_points_ = graph_.gather(begin, end, k);
  local_.emplace(local_points_);
  local_search_.reset();
}

void GraphSlam::finish() {
  if (graph_.size() > 1) closer_.optimise(graph_);
}

std::vector<Pose2> GraphSlam::poses() const {
  // A scan between two keyframes was located relative to the first; what optimisation changed between the two is spread
  // over the scans between.
  std::vector<Pose2> result;
  result.reserve(scans_.size());
  for (const Tracked& scan : scans_) {
    const std::size_t k = scan.keyframe;
    Pose2 T = graph_.poses[k] * scan.T_keyframe_robot;
    if (k + 1 < graph_.size() && scan.T_keyframe_robot != Pose2{}) {
      const std::size_t a = graph_.frames[k].index, b = graph_.frames[k + 1].index;
      const double s = static_cast<double>(result.size() - a) / static_cast<double>(b - a);
      const Pose2 dead = graph_.poses[k] * steps_[k];
      const Pose2& target = graph_.poses[k + 1];
      T = {T.x + s * (target.x - dead.x), T.y + s * (target.y - dead.y),
           wrap_angle(T.theta + s * wrap_angle(target.theta - dead.theta))};
    }
    result.push_back(T);
  }
  return result;
}

namespace {

class GraphLocalizer : public Localizer {
 public:
  explicit GraphLocalizer(const GraphSettings& settings) : slam_(settings) {}
  void add(const LogEntry& entry) override { slam_.add(entry.scan, entry.odometry); }
  void finish() override { slam_.finish(); }
  std::vector<Pose2> poses() const override { return slam_.poses(); }
  std::size_t keyframes() override { return slam_.graph().size(); }
  std::optional<SessionGraph> take_graph() override { return slam_.take(); }

 private:
  GraphSlam slam_;
};

}  // namespace

std::unique_ptr<Localizer> make_graph(double max_range_m) {
  GraphSettings settings;
  settings.max_range_m = max_range_m;
  return std::make_unique<GraphLocalizer>(settings);
}

std::vector<ClosureRecord> records(const KeyframeGraph& graph, const std::vector<LoopClosure>& closures) {
  std::vector<ClosureRecord> all;
  for (const LoopClosure& c : closures) {
    const Pose2 r = residual({c.from, c.to, c.T_from_to}, graph.poses);
    const Keyframe &from = graph.frames[c.from], &to = graph.frames[c.to];
    all.push_back({from.session, to.session, from.t, to.t, c.T_from_to, std::hypot(r.x, r.y),
                   std::abs(r.theta) * 180.0 / kPi, c.share, c.agreement, c.accepted(), c.why});
  }
  return all;
}

}  // namespace outrider::slam_glue
