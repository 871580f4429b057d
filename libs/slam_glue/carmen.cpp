// CARMEN's text logs. One message a line:
//   FLASER n r_1..r_n  x y theta  odom_x odom_y odom_theta  ipc_time host logger_time
//   ROBOTLASER1 type start fov resolution max accuracy remission_mode  n r_1..r_n  m i_1..i_m
//               laser_x laser_y laser_theta  robot_x robot_y robot_theta  tv rv safety(2) turn  ipc_time host
//               logger_time
//   RAWLASER1 (as ROBOTLASER1 up to the intensities)  ipc_time host logger_time
//   ODOM x y theta ...
// A robot may log the same sweep under all three laser names; only one name is used.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "slam_glue/gzip.hpp"
#include "slam_glue/log_sources.hpp"
#include "world/error.hpp"

namespace outrider::slam_glue {
namespace {

enum Kind : std::size_t { kRobotLaser, kFrontLaser, kRawLaser, kKinds };
constexpr std::array<std::string_view, kKinds> kNames = {"ROBOTLASER1", "FLASER", "RAWLASER1"};

/// One laser message.
struct Message {
  Kind kind = kFrontLaser;
  LaserScan scan;         ///< without time and pose on the robot
  Pose2 laser, odometry;  ///< in one frame, unless the log is corrected
  double ipc_time = 0.0, logger_time = 0.0;
  bool has_range_max = false;  ///< the message states the laser's limits itself
};

/// The words of a line, taken one by one.
class Words {
 public:
  Words(std::string_view line, const std::string& file, std::size_t number)
      : rest_(line), file_(file), number_(number) {}

  bool empty() { return skip(), rest_.empty(); }
  std::string_view word(std::string_view expected) {
    skip();
    if (rest_.empty()) fail(fmt::format("the line ends where {} was expected", expected));
    const std::size_t end = std::min(rest_.find_first_of(" \t"), rest_.size());
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return word;
  }
  double number(std::string_view expected) {
    const double value = any_number(expected);
    if (!std::isfinite(value)) fail(fmt::format("expected {} to be finite", expected));
    return value;
  }
  /// NaN and infinity included: some drivers write them for "no echo".
  double any_number(std::string_view expected) {
    const std::string_view text = word(expected);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size())
      fail(fmt::format("expected {}, found '{}'", expected, text.substr(0, 40)));
    return value;
  }
  std::size_t count(std::string_view expected, std::size_t least, std::size_t most) {
    const std::string_view text = word(expected);
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || value < least || value > most)
      fail(fmt::format("expected {} of {} to {}, found '{}'", expected, least, most, text.substr(0, 40)));
    return value;
  }
  Pose2 pose(std::string_view expected) {
    const double x = number(expected), y = number(expected);
    return {x, y, wrap_angle(number(expected))};
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file_, number_, what));
  }

 private:
  void skip() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t"), rest_.size())); }

  std::string_view rest_;
  const std::string& file_;
  std::size_t number_;
};

void read_ranges(Words& words, LaserScan& scan) {
  scan.ranges.resize(words.count("a number of beams", 1, kMostBeams));
  for (float& range : scan.ranges) range = static_cast<float>(words.any_number("a range"));
}

/// ipc_time [host logger_time]
void read_times(Words& words, Message& m) {
  m.ipc_time = m.logger_time = words.number("a time stamp");
  if (words.empty()) return;
  words.word("a host name");
  m.logger_time = words.number("the logger's time stamp");
}

/// FLASER states no angles: 180 degrees, with a SICK's habit of dropping the last beam of 181, 361, ...
void set_default_angles(LaserScan& scan) {
  const std::size_t n = scan.ranges.size();
  scan.angle_min = -0.5 * kPi;
  if (n > 1) scan.angle_increment = kPi / static_cast<double>(n % 2 == 0 ? n : n - 1);
}

Message read_flaser(Words& words) {
  Message m;
  read_ranges(words, m.scan);
  set_default_angles(m.scan);
  m.laser = words.pose("the laser's pose");
  m.odometry = words.pose("the robot's pose");
  read_times(words, m);
  return m;
}

Message read_configured_laser(Words& words, Kind kind) {
  Message m;
  m.kind = kind;
  words.number("the laser's type");
  const double start = words.number("the start angle"), fov = words.number("the field of view");
  const double resolution = words.number("the angular resolution");
  m.scan.range_max = words.number("the maximum range");
  m.has_range_max = true;
  words.number("the accuracy");
  words.number("the remission mode");
  read_ranges(words, m.scan);
  for (std::size_t i = words.count("a number of remissions", 0, kMostBeams); i > 0; --i)
    words.any_number("a remission");
  const auto intervals = static_cast<double>(m.scan.ranges.size() - 1);
  m.scan.angle_min = start;
  // The written resolution has few digits; the field of view tells it better, unless the two disagree (a cut scan).
  const double from_fov = intervals > 0 ? fov / intervals : 0.0;
  m.scan.angle_increment =
      resolution > 0.0 && std::abs(from_fov - resolution) > 1e-3 * resolution ? resolution : from_fov;
  if (!(std::abs(m.scan.angle_increment) * intervals < 2.1 * kPi)) words.fail("the beams span more than a turn");
  if (!(m.scan.range_max > 0.0)) words.fail("expected a maximum range above 0");
  if (kind == kRobotLaser) {
    m.laser = words.pose("the laser's pose");
    m.odometry = words.pose("the robot's pose");
    for (int i = 0; i < 5; ++i) words.number("velocities and safety distances");
  }
  read_times(words, m);
  return m;
}

/// Which of the time stamps of a log to believe, and in which unit.
class Clock {
 public:
  void see(const Message& m) {
    ++scans_;
    if (scans_ == 1) first_ipc_ = last_ipc_ = m.ipc_time, first_logger_ = last_logger_ = m.logger_time;
    if (m.ipc_time > last_ipc_) ++ipc_steps_;
    if (m.logger_time > last_logger_) ++logger_steps_;
    last_ipc_ = m.ipc_time;
    last_logger_ = m.logger_time;
  }
  /// The time of the sensor (ipc) unless it stands still for most scans while the logger's runs on: simulators write
  /// whole seconds there, and the logger's milliseconds are then the finer clock.
  double time(const Message& m) const { return time(m.ipc_time, m.logger_time); }
  double first() const { return time(first_ipc_, first_logger_); }
  double last() const { return time(last_ipc_, last_logger_); }

 private:
  double time(double ipc, double logger) const {
    if (2 * ipc_steps_ >= logger_steps_) return ipc;
    const double span = last_ipc_ - first_ipc_, ratio = (last_logger_ - first_logger_) / span;
    return logger * (span > 0.0 && ratio > 500.0 && ratio < 2000.0 ? 1e-3 : 1.0);
  }

  std::size_t scans_ = 0, ipc_steps_ = 0, logger_steps_ = 0;
  double first_ipc_ = 0.0, last_ipc_ = 0.0, first_logger_ = 0.0, last_logger_ = 0.0;
};

/// Whether the laser's pose differs from the robot's by a fixed mounting, or because somebody corrected the log.
class Mounting {
 public:
  void see(const Message& m) {
    const Pose2 T = inverse(m.odometry) * m.laser;
    if (!first_) first_ = T;
    const Pose2 change = inverse(*first_) * T;
    constexpr double kRounding = 2e-3;  // poses are written with few digits [m, rad]
    if (std::hypot(change.x, change.y) > kRounding || std::abs(change.theta) > kRounding) corrected_ = true;
  }
  void set_parameter(double forward) { parameter_ = forward; }
  bool corrected() const { return corrected_ || (first_ && std::hypot(first_->x, first_->y) > kFarthest); }
  /// T_robot_sensor
  Pose2 offset() const { return corrected() || !first_ ? Pose2{parameter_, 0.0, 0.0} : *first_; }

 private:
  static constexpr double kFarthest = 3.0;  // no laser is mounted farther from the robot's centre [m]
  std::optional<Pose2> first_;
  bool corrected_ = false;
  double parameter_ = 0.0;
};

class CarmenLog : public LogReader::Source {
 public:
  explicit CarmenLog(const std::filesystem::path& file) : file_(file), name_(file.string()) {}

  LogInfo inspect() override {
    std::array<std::size_t, kKinds> counts{};
    std::array<Clock, kKinds> clocks;
    std::array<Mounting, kKinds> mountings;
    bool odometry = false;
    const auto on_scan = [&](const Message& m) {
      ++counts[m.kind];
      clocks[m.kind].see(m);
      mountings[m.kind].see(m);
      odometry = odometry || m.odometry != Pose2{};
      return true;
    };
    for_each_message(on_scan, [&](Words& words) { read_parameter(words); });
    // ROBOTLASER1 knows most; RAWLASER1 has no poses and serves only alone.
    kind_ = counts[kFrontLaser] > counts[kRobotLaser] ? kFrontLaser : counts[kRobotLaser] > 0 ? kRobotLaser : kRawLaser;
    clock_ = clocks[kind_];
    mounting_ = mountings[kind_];
    mounting_.set_parameter(laser_forward_.value_or(0.0));
    return {"carmen", counts[kind_], clock_.first(), clock_.last(), odometry};
  }

  void read(const std::function<bool(const LogEntry&)>& on_scan) const override {
    const Pose2 T_robot_sensor = mounting_.offset();
    const auto on_message = [&](Message& m) {
      if (m.kind != kind_) return true;
      LogEntry entry{std::move(m.scan), m.odometry, std::nullopt};
      entry.scan.t = clock_.time(m);
      entry.scan.T_robot_sensor = T_robot_sensor;
      entry.scan.range_max = usable_range(m, entry.scan);
      if (mounting_.corrected()) entry.logged_pose = m.laser * inverse(T_robot_sensor);
      return on_scan(entry);
    };
    for_each_message(on_message, [](Words&) {});
  }

 private:
  /// Where a reading stops being an echo [m]. SICK lasers write error codes from 81.83 m on for "no echo".
  double usable_range(const Message& m, const LaserScan& scan) const {
    constexpr double kSickLimit = 81.0;
    const double stated = m.has_range_max ? scan.range_max : range_max_.value_or(kSickLimit);
    return stated > kSickLimit && stated < 83.0 ? kSickLimit : stated;
  }

  void read_parameter(Words& words) {
    const std::string_view key = words.empty() ? "" : words.word("a name");
    if (key == "robot_front_laser_max" || key == "robot_frontlaser_max") range_max_ = words.number("a range");
    if (key == "robot_frontlaser_offset") laser_forward_ = words.number("a distance");
  }

  /// Visits every laser message, whose scan may be taken away, until `visit` returns false, and every parameter.
  template <class Visit, class VisitParameter>
  void for_each_message(Visit&& visit, VisitParameter&& on_parameter) const {
    GzipReader reader(file_);
    std::string line;
    Pose2 odometry;  // of the last ODOM, for RAWLASER1
    while (reader.next_line(line)) {
      if (line.find('\0') != std::string::npos)
        throw InputError(fmt::format("{}:{}: not text; expected a CARMEN log", name_, reader.line_number()));
      Words words(line, name_, reader.line_number());
      if (words.empty() || line.starts_with('#')) continue;
      const std::string_view name = words.word("a message name");
      if (name == "PARAM") on_parameter(words);
      if (name == "ODOM") odometry = words.pose("the robot's pose");
      const auto kind = static_cast<std::size_t>(std::find(kNames.begin(), kNames.end(), name) - kNames.begin());
      if (kind == kKinds) continue;
      Message m = kind == kFrontLaser ? read_flaser(words) : read_configured_laser(words, static_cast<Kind>(kind));
      if (kind == kRawLaser) m.laser = m.odometry = odometry;
      if (!visit(m)) return;
    }
  }

  std::filesystem::path file_;
  std::string name_;
  Kind kind_ = kFrontLaser;
  Clock clock_;
  Mounting mounting_;
  std::optional<double> range_max_, laser_forward_;  ///< PARAMs, if any [m]
};

}  // namespace

std::unique_ptr<LogReader::Source> open_carmen(const std::filesystem::path& file) {
  return std::make_unique<CarmenLog>(file);
}

}  // namespace outrider::slam_glue
