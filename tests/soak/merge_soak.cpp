// Merges with unknown starts: the halves of every log, which must fit together as in the whole log or be refused, and
// every pair of logs of different buildings, which must be refused. `merge_soak [--halves] BUILDING=LOG...`; not part
// of ctest. Logs of one building are merged too, and the transform is printed for a look.

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <vector>

#include "slam_glue/evaluation.hpp"
#include "slam_glue/localizer.hpp"
#include "slam_glue/session_merge.hpp"

namespace {

using namespace outrider;
using namespace outrider::slam_glue;

constexpr double kMaxRange = 30.0;
constexpr double kRight = 0.5;  // largest error of a merge that counts as right, after alignment [m]

struct Log {
  std::string building, name;
  std::vector<SessionGraph> halves;
  SessionGraph whole;
  std::vector<Pose2> truth;  ///< of every scan, by the whole log
};

SessionGraph localise(const std::vector<LogEntry>& scans, std::size_t begin, std::size_t end,
                      std::vector<Pose2>* poses) {
  const auto localizer = make_graph(kMaxRange);
  for (std::size_t i = begin; i < end; ++i) localizer->add(scans[i]);
  localizer->finish();
  if (poses) *poses = localizer->poses();
  return *localizer->take_graph();
}

Log load(const std::string& argument) {
  const auto split = argument.find('=');
  const std::filesystem::path file = argument.substr(split + 1);
  Log log{argument.substr(0, split), file.stem().string(), {}, {}, {}};
  std::vector<LogEntry> scans;
  LogReader(file).read([&](const LogEntry& entry, double) {
    scans.push_back(entry);
    return true;
  });
  const std::size_t half = scans.size() / 2;
  log.whole = localise(scans, 0, scans.size(), &log.truth);
  log.halves = {localise(scans, 0, half, nullptr), localise(scans, half, scans.size(), nullptr)};
  return log;
}

/// Error of the merged halves against the whole log, after alignment [m].
double error_of(const JointGraph& joint, const Log& log) {
  PosePairs pairs;
  for (std::size_t k = 0; k < joint.graph.size(); ++k) {
    const Keyframe& frame = joint.graph.frames[k];
    pairs.ours.push_back(joint.graph.poses[k]);
    pairs.reference.push_back(log.truth[frame.index + (frame.session == 1 ? log.truth.size() / 2 : 0)]);
  }
  return absolute_trajectory_error(pairs).error_m.rmse;
}

std::string text(const MergeRecord& r) {
  return fmt::format(
      "places {:2} rival {:.2f} closures {:3} agree {:.3f} hit {:.2f} overlap {:.0f} m2 landmarks {:.1f} m2 missing "
      "{:.3f} {}",
      r.places, r.rival, r.closures, r.agreement, r.hit_ratio, r.overlap_m2, r.landmarks_m2, r.missing, r.why);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<Log> logs;
  const bool only_halves = argc > 1 && std::string(argv[1]) == "--halves";
  for (int i = only_halves ? 2 : 1; i < argc; ++i) logs.push_back(load(argv[i]));
  int wrong = 0;
  for (const Log& log : logs) {
    JointGraph joint(log.halves);
    const MergeRecord r = merge_sessions(joint, false)[0];
    const double error = r.accepted ? error_of(joint, log) : 0.0;
    const bool bad = error > kRight;
    wrong += bad;
    fmt::print("{} halves of {}: {:.2f} m; {}\n",
               bad          ? "WRONG  "
               : r.accepted ? "right  "
                            : "refused",
               log.name, error, text(r));
    std::fflush(stdout);
  }
  for (std::size_t a = 0; a < logs.size() && !only_halves; ++a)
    for (std::size_t b = a + 1; b < logs.size(); ++b) {
      const bool same = logs[a].building == logs[b].building;
      JointGraph joint({logs[a].whole, logs[b].whole});
      const MergeRecord r = merge_sessions(joint, false)[0];
      const Pose2& start = joint.graph.poses[joint.begin[1]];
      wrong += r.accepted && !same;
      fmt::print("{} {} and {}: at {:.2f} {:.2f} {:.3f}; {}\n",
                 !r.accepted ? "refused"
                 : same      ? "merged "
                             : "WRONG  ",
                 logs[a].name, logs[b].name, start.x, start.y, start.theta, text(r));
      std::fflush(stdout);
    }
  fmt::print("{} wrong\n", wrong);
  return wrong == 0 ? 0 : 1;
}
