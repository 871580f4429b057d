#pragma once
// What every verb shares: common flags, and where results, progress and interrupts go.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace outrider::app {

inline constexpr int kDone = 0;         ///< the aim was reached
inline constexpr int kAimMissed = 1;    ///< the run ended without reaching its aim
inline constexpr int kBadInput = 2;     ///< bad usage or bad input
inline constexpr int kInterrupted = 130;

struct Context {
  std::vector<std::string> argv;
  bool quiet = false;
  bool verbose = false;
  bool json = false;                    ///< the result as one JSON document on stdout, nothing else there
  std::filesystem::path out;            ///< run folder; empty: the verb's default
  bool force = false;
  std::uint64_t seed = 1;
  int jobs = 1;
  const std::atomic<bool>* interrupted = nullptr;  ///< set by the first Ctrl-C
  int exit_code = kDone;                ///< what the verb's callback leaves
};

/// Adds --json -q -v to a verb.
void add_output_flags(CLI::App& verb, Context& ctx);
/// Adds these and --out --force --jobs to a verb that makes a folder.
void add_work_flags(CLI::App& verb, Context& ctx);
/// Adds these and --seed.
void add_run_flags(CLI::App& verb, Context& ctx);

/// Accepts finite numbers from `low` to `high` only (CLI::Range lets nan through).
CLI::Validator number_in(double low, double high);

// One file a verb (those that need the map room: maps_module.hpp). Each adds its subcommand; the callback runs it and sets ctx.exit_code.
void add_explore(CLI::App& app, Context& ctx);
void add_robot(CLI::App& app, Context& ctx);
void add_team(CLI::App& app, Context& ctx);
void add_watch(CLI::App& app, Context& ctx);
void add_allocate(CLI::App& app, Context& ctx);
void add_report(CLI::App& app, Context& ctx);
void add_bench(CLI::App& app, Context& ctx);
void add_sweep(CLI::App& app, Context& ctx);
void add_list(CLI::App& app, Context& ctx);

}  // namespace outrider::app
