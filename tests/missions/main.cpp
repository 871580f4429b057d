// mission_fuzz: thousands of short random missions, each twice. No collision, no deadlock, no reachable space left
// unexplored while a robot lives, no difference between two runs of a seed.
//   mission_fuzz [--missions N] [--first K] [--jobs N] [--tolerate N] [--show K]
// Collisions and differences are never tolerated.

#include <fmt/format.h>

#include <atomic>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <thread>

#include "missions/scenario.hpp"

namespace outrider::test {
namespace {

struct Options {
  std::uint64_t missions = 300, first = 1, jobs = 1, tolerate = 0, show = 0;
};

bool parse(int argc, char** argv, Options& o) {
  for (int i = 1; i + 1 < argc; i += 2) {
    std::uint64_t* value = std::strcmp(argv[i], "--missions") == 0 ? &o.missions
                           : std::strcmp(argv[i], "--first") == 0  ? &o.first
                           : std::strcmp(argv[i], "--jobs") == 0   ? &o.jobs
                           : std::strcmp(argv[i], "--tolerate") == 0 ? &o.tolerate
                           : std::strcmp(argv[i], "--show") == 0   ? &o.show : nullptr;
    const char* end = argv[i + 1] + std::strlen(argv[i + 1]);
    if (value == nullptr || std::from_chars(argv[i + 1], end, *value).ptr != end) return false;
  }
  return argc % 2 == 1;
}

/// One mission in detail.
int show(std::uint64_t number) {
  const Scenario s = draw_scenario(number);
  fmt::print("{}: {}\n", number, s.text);
  const auto result = explorer::run_mission(s.truth, s.team, s.settings);
  for (const auto& [t, event] : result.events)
    if (const auto* phase = std::get_if<explorer::PhaseEvent>(&event)) fmt::print("{:8.1f} s  r{} {}\n", t, phase->robot + 1, phase->phase);
    else if (const auto* goal = std::get_if<explorer::GoalEvent>(&event))
      fmt::print("{:8.1f} s  r{} to ({}, {}) from ({}, {})\n", t, goal->robot + 1, goal->task.cell.x, goal->task.cell.y,
                 goal->task.stand.x, goal->task.stand.y);
    else if (const auto* fault = std::get_if<explorer::FaultEvent>(&event)) fmt::print("{:8.1f} s  r{} {}\n", t, fault->robot + 1, fault->what);
    else if (const auto* over = std::get_if<explorer::TaskEndEvent>(&event)) fmt::print("{:8.1f} s  r{} ({}, {}) {}\n", t, over->robot + 1, over->task.x, over->task.y, over->how);
  fmt::print("{} after {:.1f} s\n{}", explorer::to_string(result.status), result.mission_time_s, picture(s, result));
  for (const auto& left : result.left)
    fmt::print("left at ({:.1f}, {:.1f}): {}\n", left.frontier.x, left.frontier.y, explorer::to_string(left.why));
  const auto problems = check_scenario(s);
  for (const auto& problem : problems) fmt::print("{}\n", problem.text);
  return problems.empty() ? 0 : 1;
}

int run(const Options& o) {
  std::atomic<std::uint64_t> next{o.first}, failures{0}, broken{0};
  std::mutex mutex;
  const auto work = [&] {
    for (std::uint64_t number; (number = next++) < o.first + o.missions;) {
      const Scenario s = draw_scenario(number);
      const auto problems = check_scenario(s);
      if (problems.empty()) continue;
      ++failures;
      const std::lock_guard lock(mutex);
      for (const auto& problem : problems) {
        broken += problem.never;
        fmt::print("mission {}: {}\n  {}\n", number, problem.text, s.text);
      }
      std::fflush(stdout);
    }
  };
  {
    std::vector<std::jthread> threads;
    for (std::uint64_t k = 1; k < o.jobs; ++k) threads.emplace_back(work);
    work();
  }
  fmt::print("{} missions, {} failed\n", o.missions, failures.load());
  return failures <= o.tolerate && broken == 0 ? 0 : 1;
}

}  // namespace
}  // namespace outrider::test

int main(int argc, char** argv) {
  outrider::test::Options options;
  if (!outrider::test::parse(argc, argv, options)) {
    fmt::print(stderr, "usage: mission_fuzz [--missions N] [--first K] [--jobs N] [--tolerate N] [--show K]\n");
    return 2;
  }
  return options.show > 0 ? outrider::test::show(options.show) : outrider::test::run(options);
}
