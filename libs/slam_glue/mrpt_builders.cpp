// MRPT's SLAM. Traps that are avoided here: a builder reads the process's clock, so that is simulated and follows the
// log; actions without a time stamp throw; the builders talk on stdout unless silenced.

#include <mrpt/core/Clock.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDF.h>
#include <mrpt/random/RandomGenerators.h>
#include <mrpt/slam/CMetricMapBuilderICP.h>
#include <mrpt/slam/CMetricMapBuilderRBPF.h>

#include "slam_glue/localizer.hpp"

namespace outrider::slam_glue {
namespace {

using mrpt::obs::CObservation2DRangeScan;

mrpt::Clock::time_point set_clock(double t) {
  const auto time = mrpt::Clock::fromDouble(t);
  mrpt::Clock::setActiveClock(mrpt::Clock::Simulated);
  mrpt::Clock::setSimulatedTime(time);
  return time;
}

mrpt::poses::CPose2D to_mrpt(const Pose2& p) { return {p.x, p.y, p.theta}; }

/// MRPT's scan; beams beyond `max_range_m` count as no echo.
CObservation2DRangeScan::Ptr to_mrpt(const LaserScan& scan, double max_range_m, mrpt::Clock::time_point time) {
  auto obs = CObservation2DRangeScan::Create();
  const std::size_t n = scan.ranges.size();
  obs->timestamp = time;
  obs->sensorLabel = "laser";
  obs->rightToLeft = scan.angle_increment >= 0.0;
  obs->aperture = static_cast<float>(std::abs(scan.angle_increment) * static_cast<double>(n - 1));
  obs->maxRange = static_cast<float>(std::min(scan.range_max, max_range_m));
  // MRPT's apertures are centred ahead; turn the sensor so that the middle beam points where it does in the scan.
  const double middle = scan.angle_min + 0.5 * scan.angle_increment * static_cast<double>(n - 1);
  const Pose2& T = scan.T_robot_sensor;
  obs->sensorPose = mrpt::poses::CPose3D(T.x, T.y, 0.0, T.theta + middle, 0.0, 0.0);
  obs->resizeScan(n);
  for (std::size_t i = 0; i < n; ++i) {
    const bool valid = scan.valid(i) && scan.ranges[i] < obs->maxRange;
    obs->setScanRange(i, valid ? scan.ranges[i] : 0.0F);
    obs->setScanRangeValidity(i, valid);
  }
  return obs;
}

Pose2 mean_of(const mrpt::slam::CMetricMapBuilder& builder) {
  const auto p = builder.getCurrentPoseEstimation()->getMeanVal();
  return {p.x(), p.y(), wrap_angle(p.yaw())};
}

mrpt::maps::TSetOfMetricMapInitializers points_map(double spacing_m) {
  mrpt::maps::CSimplePointsMap::TMapDefinition definition;
  definition.insertionOpts.minDistBetweenLaserPoints = static_cast<float>(spacing_m);
  definition.insertionOpts.isPlanarMap = true;
  definition.likelihoodOpts.max_corr_distance = 1.0;
  definition.likelihoodOpts.sigma_dist = 0.05;
  mrpt::maps::TSetOfMetricMapInitializers maps;
  maps.push_back(definition);
  return maps;
}

class IcpLocalizer : public Localizer {
 public:
  explicit IcpLocalizer(const IcpSettings& s) : settings_(s) {
    builder_.setVerbosityLevel(mrpt::system::LVL_ERROR);
    auto& icp = builder_.ICP_params;
    icp.ICP_algorithm = mrpt::slam::icpClassic;
    icp.maxIterations = s.max_iterations;
    icp.minAbsStep_trans = 1e-5;
    icp.minAbsStep_rot = 1e-5;
    icp.thresholdDist = s.threshold_m;
    icp.thresholdAng = s.threshold_rad;
    icp.smallestThresholdDist = s.smallest_threshold_m;
    icp.ALFA = s.shrink;
    icp.onlyUniqueRobust = true;
    icp.skip_cov_calculation = true;
    icp.corresponding_points_decimation = s.decimation;
    auto& slam = builder_.ICP_options;
    slam.matchAgainstTheGrid = false;
    slam.localizationLinDistance = s.locate_every_m;
    slam.localizationAngDistance = s.locate_every_rad;
    slam.insertionLinDistance = s.insert_every_m;
    slam.insertionAngDistance = s.insert_every_rad;
    slam.minICPgoodnessToAccept = s.least_goodness;
    slam.mapInitializers = points_map(s.point_spacing_m);
  }

  void add(const LogEntry& entry) override {
    const auto time = set_clock(entry.scan.t);
    if (poses_.empty()) {
      builder_.initialize();
      first_odometry_ = entry.odometry;
    }
    auto odometry = mrpt::obs::CObservationOdometry::Create();
    odometry->timestamp = time;
    odometry->sensorLabel = "odometry";
    odometry->odometry = to_mrpt(inverse(first_odometry_) * entry.odometry);
    builder_.processObservation(odometry);
    builder_.processObservation(to_mrpt(entry.scan, settings_.max_range_m, time));
    poses_.push_back(mean_of(builder_));
  }
  std::vector<Pose2> poses() const override { return poses_; }
  std::size_t keyframes() override { return builder_.getCurrentlyBuiltMapSize(); }

 private:
  IcpSettings settings_;
  mrpt::slam::CMetricMapBuilderICP builder_;
  Pose2 first_odometry_;
  std::vector<Pose2> poses_;
};

/// The filter moves only after some way; the scans between are put on the odometry's path, bent to meet both ends.
class RbpfLocalizer : public Localizer {
 public:
  explicit RbpfLocalizer(const RbpfSettings& s) : settings_(s), builder_(options(s)) {
    builder_.setVerbosityLevel(mrpt::system::LVL_ERROR);
    builder_.mapPDF.setVerbosityLevel(mrpt::system::LVL_ERROR);
    mrpt::random::getRandomGenerator().randomize(static_cast<std::uint32_t>(s.seed));
  }

  void add(const LogEntry& entry) override {
    const auto time = set_clock(entry.scan.t);
    if (odometry_.empty()) builder_.initialize();
    const Pose2 move = odometry_.empty() ? Pose2{} : inverse(odometry_.back()) * entry.odometry;
    odometry_.push_back(entry.odometry);
    mrpt::obs::CActionCollection actions;
    mrpt::obs::CActionRobotMovement2D action;
    mrpt::obs::CActionRobotMovement2D::TMotionModelOptions model;
    action.timestamp = time;
    action.computeFromOdometry(to_mrpt(move), model);
    actions.insert(action);
    mrpt::obs::CSensoryFrame frame;
    frame.insert(to_mrpt(entry.scan, settings_.max_range_m, time));
    builder_.processActionObservation(actions, frame);
    const std::size_t length = path().size();
    nodes_.resize(length, odometry_.size() - 1);  // the scan at which the path grew
  }

  std::vector<Pose2> poses() const override;
  std::size_t keyframes() override { return builder_.getCurrentlyBuiltMapSize(); }

 private:
  static mrpt::slam::CMetricMapBuilderRBPF::TConstructionOptions options(const RbpfSettings& s);
  std::deque<mrpt::math::TPose3D> path() const {
    std::deque<mrpt::math::TPose3D> path;
    builder_.getCurrentMostLikelyPath(path);
    return path;
  }

  RbpfSettings settings_;
  mrpt::slam::CMetricMapBuilderRBPF builder_;
  std::vector<Pose2> odometry_;     ///< of every scan
  std::vector<std::size_t> nodes_;  ///< the scan of every pose on the filter's path
};

mrpt::slam::CMetricMapBuilderRBPF::TConstructionOptions RbpfLocalizer::options(const RbpfSettings& s) {
  mrpt::slam::CMetricMapBuilderRBPF::TConstructionOptions o;
  o.insertionLinDistance = o.localizeLinDistance = static_cast<float>(s.update_every_m);
  o.insertionAngDistance = o.localizeAngDistance = static_cast<float>(s.update_every_rad);
  o.PF_options.PF_algorithm = mrpt::bayes::CParticleFilter::pfOptimalProposal;
  o.PF_options.adaptiveSampleSize = false;
  o.PF_options.sampleSize = static_cast<unsigned>(s.particles);
  o.PF_options.BETA = 0.5;
  o.PF_options.resamplingMethod = mrpt::bayes::CParticleFilter::prSystematic;
  o.mapsInitializers = points_map(0.1);
  auto& prediction = o.predictionOptions;
  prediction.pfOptimalProposal_mapSelection = 3;  // scan matching against the points map
  auto& icp = prediction.icp_params;
  icp.ICP_algorithm = mrpt::slam::icpClassic;
  icp.maxIterations = 60;
  icp.thresholdDist = 0.6;
  icp.thresholdAng = 5.0 * kPi / 180.0;
  icp.ALFA = 0.5;
  icp.smallestThresholdDist = 0.1;
  icp.onlyUniqueRobust = true;
  o.verbosity_level = mrpt::system::LVL_ERROR;
  return o;
}

std::vector<Pose2> RbpfLocalizer::poses() const {
  std::vector<Pose2> result;
  const auto nodes = path();
  if (odometry_.empty()) return result;
  result.reserve(odometry_.size());
  // The filter begins at the origin with the first scan.
  std::size_t scan = 0;
  Pose2 pose;
  for (std::size_t k = 0; k <= nodes.size(); ++k) {
    const bool last = k == nodes.size();
    const std::size_t end = last ? odometry_.size() - 1 : nodes_[k];
    const Pose2 dead = pose * (inverse(odometry_[scan]) * odometry_[end]);  // where odometry alone would lead
    const Pose2 target = last ? dead : Pose2{nodes[k].x, nodes[k].y, nodes[k].yaw};
    for (std::size_t i = result.size(); i <= end; ++i) {
      const double share = end == scan ? 1.0 : static_cast<double>(i - scan) / static_cast<double>(end - scan);
      const Pose2 raw = pose * (inverse(odometry_[scan]) * odometry_[i]);
      result.push_back({raw.x + share * (target.x - dead.x), raw.y + share * (target.y - dead.y),
                        wrap_angle(raw.theta + share * wrap_angle(target.theta - dead.theta))});
    }
    pose = target;
    scan = end;
  }
  return result;
}

}  // namespace

std::unique_ptr<Localizer> make_icp(const IcpSettings& settings) { return std::make_unique<IcpLocalizer>(settings); }
std::unique_ptr<Localizer> make_rbpf(const RbpfSettings& settings) { return std::make_unique<RbpfLocalizer>(settings); }

}  // namespace outrider::slam_glue
