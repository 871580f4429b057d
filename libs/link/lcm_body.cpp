#include "link/lcm_body.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "bot_core/planar_lidar_t.hpp"
#include "bot_core/pose_t.hpp"
#include "link/lc02.hpp"
#include "outrider_wire/path_t.hpp"
#include "outrider_wire/velocity_command_t.hpp"
#include "world/error.hpp"

namespace outrider::link {
namespace {

constexpr std::uint32_t kMostBeams = 8192;
constexpr double kTurnOnTheSpot = 1.0;  // [rad] off the way

std::uint32_t big_endian32(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) value = value << 8U | bytes[at + k];
  return value;
}

MulticastSocket open_or_throw(const MulticastUrl& url) {
  std::string why;
  auto socket = MulticastSocket::open(url, why);
  if (!socket) throw InputError("the body's network: " + why);
  return std::move(*socket);
}

std::int64_t wall_clock_us() {
  using namespace std::chrono;
  return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
}

}  // namespace

std::optional<LaserScan> parse_planar_lidar(std::span<const std::uint8_t> payload, double range_max) {
  // fingerprint 8, utime 8, nranges 4, ranges, nintensities 4, intensities, rad0 4, radstep 4
  if (payload.size() < 32) return std::nullopt;
  const std::size_t beams = big_endian32(payload, 16);
  if (beams < 2 || beams > kMostBeams || payload.size() < 32 + 4 * beams) return std::nullopt;
  const std::size_t intensities = big_endian32(payload, 20 + 4 * beams);
  if (intensities > kMostBeams || payload.size() != 32 + 4 * (beams + intensities)) return std::nullopt;
  bot_core::planar_lidar_t wire{};
  const int size = static_cast<int>(payload.size());
  if (wire.decode(payload.data(), 0, size) != size) return std::nullopt;
  if (!std::isfinite(wire.rad0) || !std::isfinite(wire.radstep) || wire.radstep == 0.0F) return std::nullopt;
  LaserScan scan;
  scan.t = static_cast<double>(wire.utime) * 1e-6;
  scan.angle_min = wire.rad0;
  scan.angle_increment = wire.radstep;
  scan.range_max = range_max;
  scan.ranges = std::move(wire.ranges);
  for (float& range : scan.ranges)
    if (!std::isfinite(range) || range < 0.0F) range = static_cast<float>(range_max);  // no echo
  return scan;
}

std::optional<Pose2> parse_pose(std::span<const std::uint8_t> payload) {
  bot_core::pose_t wire{};
  const int size = static_cast<int>(payload.size());
  if (size != wire.getEncodedSize() || wire.decode(payload.data(), 0, size) != size) return std::nullopt;
  const auto& [w, x, y, z] = wire.orientation;
  const double theta = std::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
  const bool good = std::isfinite(theta) && std::abs(wire.pos[0]) < 1e7 && std::abs(wire.pos[1]) < 1e7;
  return good ? std::optional(Pose2{wire.pos[0], wire.pos[1], theta}) : std::nullopt;
}

Velocity pursue(const Pose2& pose, std::vector<Point>& path, double speed, double arrive_m) {
  const auto ahead = std::find_if(path.begin(), path.end(), [&](Point p) { return distance(pose.position(), p) > arrive_m; });
  path.erase(path.begin(), ahead);
  if (path.empty()) return {};
  const Point aim = path.front();
  const double off = std::remainder(std::atan2(aim.y - pose.y, aim.x - pose.x) - pose.theta, 2.0 * kPi);
  if (std::abs(off) > kTurnOnTheSpot) return {0.0, std::copysign(1.0, off)};
  return {speed, 2.0 * speed * std::sin(off) / distance(pose.position(), aim)};  // the arc through the aim
}

LcmBody::LcmBody(const MulticastUrl& url, LcmBodySettings settings) : settings_(std::move(settings)), socket_(open_or_throw(url)) {
  gathering_.arrived = true;
}

const Sensing& LcmBody::sense() {
  std::array<std::uint8_t, 65536> buffer;
  for (int k = 0; k < 1024; ++k) {
    const auto size = socket_.receive(buffer);
    if (!size) break;
    hear({buffer.data(), *size});
  }
  delivered_.scans.clear();
  std::swap(delivered_.scans, gathering_.scans);
  delivered_.pose = gathering_.pose;
  const Velocity v = pursue(delivered_.pose, path_, settings_.speed, settings_.arrive_m);
  delivered_.arrived = path_.empty();
  outrider_wire::velocity_command_t wire{};
  wire.utime = wall_clock_us();
  wire.linear = v.linear;
  wire.angular = v.angular;
  publish(settings_.velocity, wire);
  return delivered_;
}

void LcmBody::follow(std::span<const Point> way_points) {
  path_.assign(way_points.begin(), way_points.end());
  outrider_wire::path_t wire{};
  wire.utime = wall_clock_us();
  wire.n_points = static_cast<std::int16_t>(std::min<std::size_t>(path_.size(), 64));  // one frame; the rest follows
  for (std::size_t k = 0; k < static_cast<std::size_t>(wire.n_points); ++k) {
    wire.x.push_back(path_[k].x);
    wire.y.push_back(path_[k].y);
  }
  publish(settings_.path, wire);
}

void LcmBody::hear(std::span<const std::uint8_t> datagram) {
  const auto frame = parse_lc02(datagram);
  if (const auto* why = std::get_if<Rejection>(&frame)) {
    ++rejections_[*why];
    return;
  }
  const Lc02& message = std::get<Lc02>(frame);
  if (message.channel == settings_.pose) {
    if (const auto pose = parse_pose(message.payload)) move_to(*pose);
    else ++rejections_[Rejection::kLength];
  } else if (message.channel == settings_.laser) {
    auto scan = parse_planar_lidar(message.payload, settings_.range_max);
    if (!scan) ++rejections_[Rejection::kLength];
    if (!scan || !has_pose_) return;  // a scan from nowhere is of no use
    scan->T_robot_sensor = settings_.T_robot_sensor;
    gathering_.scans.push_back({gathering_.pose, std::move(*scan)});
  }
}

void LcmBody::move_to(const Pose2& pose) {
  if (has_pose_) path_m_ += distance(gathering_.pose.position(), pose.position());
  gathering_.pose = pose;
  has_pose_ = true;
}

template <class Wire>
void LcmBody::publish(const std::string& channel, const Wire& wire) {
  std::vector<std::uint8_t> payload(static_cast<std::size_t>(wire.getEncodedSize()));
  wire.encode(payload.data(), 0, static_cast<int>(payload.size()));
  socket_.send(make_lc02(++sequence_, channel, payload));
}

}  // namespace outrider::link
