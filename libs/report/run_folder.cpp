#include "report/run_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

#include "report/html.hpp"
#include "report/metrics.hpp"
#include "world/error.hpp"

namespace outrider::report {
namespace {

namespace fs = std::filesystem;

/// What a run folder may hold. run.json is not among them: it goes first and comes last.
constexpr std::array kEntries{"timeline.csv", "events.jsonl", "trajectories", "robots", "report.html",
                              "map.yaml",     "map.pgm",      "map.gridmap",  "map.bt"};
constexpr const char* kRunJson = "run.json";
constexpr const char* kStagingPrefix = ".partial-";

bool is_staging(const fs::path& path) { return path.filename().string().starts_with(kStagingPrefix); }

/// Absolute, without `.`, `..` and a slash at the end.
fs::path clean(const fs::path& dir) {
  fs::path result = fs::absolute(dir).lexically_normal();
  return result.has_filename() ? result : result.parent_path();
}

bool same_device(const fs::path& a, const fs::path& b) {
  struct stat sa {
  }, sb{};
  return stat(a.c_str(), &sa) == 0 && stat(b.c_str(), &sb) == 0 && sa.st_dev == sb.st_dev;
}

/// A directory that is removed unless it has been moved away.
class Staging {
 public:
  explicit Staging(fs::path path) : path_(std::move(path)) {
    std::error_code error;
    fs::remove_all(path_, error);  // of a run with the same process id that was killed
    if (!fs::create_directory(path_, error))
      throw std::runtime_error(fmt::format("cannot create {}: {}", path_.string(), error.message()));
  }
  ~Staging() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void move_into_place(const fs::path& staging, const fs::path& dir) {
  if (!fs::exists(dir)) {
    fs::rename(staging, dir);
    return;
  }
  fs::remove(dir / kRunJson);
  for (const char* entry : kEntries) fs::remove_all(dir / entry);
  std::vector<fs::path> entries;
  for (const auto& entry : fs::directory_iterator(staging)) entries.push_back(entry.path().filename());
  for (const fs::path& entry : entries) {
    if (entry == kRunJson) continue;
    fs::remove_all(dir / entry);
    fs::rename(staging / entry, dir / entry);
  }
  fs::rename(staging / kRunJson, dir / kRunJson);
}

std::string timeline_csv(const RunRecord& record) {
  std::string text = "time_s,explored_fraction,explored_m2";
  for (const RobotRecord& robot : record.robots) text += fmt::format(",{}_m2", robot.spec.name);
  text += '\n';
  for (const TimelineRow& row : record.timeline) {
    text += fmt::format("{:.3f},{:.6f},{:.4f}", row.time_s, row.explored_fraction, row.explored_m2);
    for (const double m2 : row.robot_m2) text += fmt::format(",{:.4f}", m2);
    text += '\n';
  }
  return text;
}

std::string tum(const std::vector<TimedPose>& trajectory) {
  std::string text;
  for (const TimedPose& p : trajectory)
    text += fmt::format("{:.6f} {:.6f} {:.6f} 0 0 0 {:.9f} {:.9f}\n", p.t, p.pose.x, p.pose.y,
                        std::sin(0.5 * p.pose.theta), std::cos(0.5 * p.pose.theta));
  return text;
}

void check_name(const std::string& name) {
  if (name.empty() || name.front() == '.' || name.find('/') != std::string::npos ||
      name.find('\0') != std::string::npos)
    throw InputError(fmt::format("robot name '{}' cannot name a file; expected letters, digits, '_' and '-'", name));
}

void write_files(const RunRecord& record, const fs::path& dir) {
  write_file(dir / "timeline.csv", timeline_csv(record));
  std::string lines;
  for (const Json& event : record.events) lines += to_text(event) + '\n';
  write_file(dir / "events.jsonl", lines);
  fs::create_directory(dir / "trajectories");
  for (const RobotRecord& robot : record.robots)
    write_file(dir / "trajectories" / (robot.spec.name + ".tum"), tum(robot.trajectory));
  write_file(dir / "report.html", report_html(record));
  write_file(dir / kRunJson, to_text(run_json(record), 2) + '\n');
}

}  // namespace

void write_file(const fs::path& path, std::string_view content) {
  const fs::path staging = path.parent_path() / (kStagingPrefix + path.filename().string());
  const auto fail = [&](int error) {
    std::error_code ignored;
    fs::remove(staging, ignored);
    throw std::runtime_error(fmt::format("cannot write {}: {}", path.string(), std::strerror(error)));
  };
  std::FILE* file = std::fopen(staging.c_str(), "wb");
  if (file == nullptr) fail(errno);
  const bool written = std::fwrite(content.data(), 1, content.size(), file) == content.size() && std::fflush(file) == 0;
  const int write_error = errno;
  const bool closed = std::fclose(file) == 0;  // a network disk may report being full only now
  if (!written || !closed) fail(written ? errno : write_error);
  std::error_code error;
  fs::rename(staging, path, error);
  if (error) fail(error.value());
}

void check_out_dir(const fs::path& dir, bool force) {
  const fs::path path = clean(dir);
  if (!fs::exists(path)) {
    fs::path ancestor = path.parent_path();
    while (!fs::exists(ancestor)) ancestor = ancestor.parent_path();
    if (!fs::is_directory(ancestor) || access(ancestor.c_str(), W_OK | X_OK) != 0)
      throw InputError(fmt::format("--out {}: cannot create it in {}: {}", dir.string(), ancestor.string(),
                                   fs::is_directory(ancestor) ? std::strerror(errno) : "not a directory"));
    return;
  }
  if (!fs::is_directory(path)) throw InputError(fmt::format("--out {}: not a directory", dir.string()));
  if (access(path.c_str(), W_OK | X_OK) != 0)
    throw InputError(fmt::format("--out {}: {}", dir.string(), std::strerror(errno)));
  if (force) return;
  for (const auto& entry : fs::directory_iterator(path))
    if (!is_staging(entry.path()))
      throw InputError(
          fmt::format("--out {}: not empty (it holds '{}'); choose another folder, or --force to replace "
                      "the run in it",
                      dir.string(), entry.path().filename().string()));
}

void write_run_folder(const RunRecord& record, const fs::path& dir, const RunFolderOptions& options,
                      const std::function<void(const fs::path& staging)>& extra) {
  check_out_dir(dir, options.force);
  for (const RobotRecord& robot : record.robots) check_name(robot.spec.name);
  const fs::path path = clean(dir);
  fs::create_directories(path.parent_path());
  const bool beside = !fs::exists(path) || same_device(path, path.parent_path());
  const std::string name = fmt::format("{}{}-{}", kStagingPrefix, path.filename().string(), getpid());
  const Staging staging((beside ? path.parent_path() : path) / name);
  if (extra) extra(staging.path());
  write_files(record, staging.path());
  move_into_place(staging.path(), path);
}

Json run_json(const RunRecord& record) {
  Json team = Json::array();
  for (const RobotRecord& robot : record.robots) {
    const RobotSpec& s = robot.spec;
    team.push_back({{"name", s.name},
                    {"start", {s.start.x, s.start.y, s.start.theta}},
                    {"speed", s.speed},
                    {"range", s.range},
                    {"fov", s.fov},
                    {"beams", s.beams},
                    {"radius", s.radius}});
  }
  return {{"schema", 1},
          {"outrider", record.version},
          {"command", record.command},
          {"seed", record.seed},
          {"verb", record.verb},
          {"world", record.world},
          {"team", team},
          {"coordinator", record.coordinator},
          {"comms", record.comms},
          {"configuration", record.configuration},
          {"result", derive_result(record)},
          {"timing", record.timing.is_null() ? Json::object() : record.timing}};
}

}  // namespace outrider::report
