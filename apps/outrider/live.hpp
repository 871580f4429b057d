#pragma once
// What `robot` and `team` share: the flags of a live run, and one robot's run from its flags to its journal.


#include <filesystem>
#include <string>

#include "context.hpp"
#include "explore.hpp"
#include "explorer/journal.hpp"
#include "link/lcm_body.hpp"

namespace outrider::app {

struct LiveOptions {
  ExploreOptions mission;
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  std::filesystem::path key_file;
  std::int32_t run = 0;
  double speed = 1.0;
  double gone_s = 60.0;
  bool real_body = false;            ///< scans and poses come over LCM
  link::LcmBodySettings body;
};

void add_live_options(CLI::App& verb, LiveOptions& o);

/// One robot on the air, until its team is done or `interrupted`. `arena` is where the bodies of a team on this
/// machine meet; empty: bodies do not meet. Everything it has to tell goes into `journal`, the farewell too. Throws
/// InputError.
explorer::LiveEnd run_robot(const LiveOptions& o, const sim::World& world, const std::vector<RobotSpec>& team, RobotId self,
                            const std::filesystem::path& arena, std::uint64_t seed, const std::atomic<bool>& interrupted,
                            const explorer::LineSink& journal);

/// The run record of a live team from the journals of its robots; wall_s goes to "timing".
report::RunRecord live_record(const LiveOptions& o, const sim::World& world, const std::vector<RobotSpec>& team,
                              std::uint64_t seed, std::vector<explorer::RobotJournal>& journals, double wall_s);

/// Seconds of CLOCK_MONOTONIC, the same in all processes of the machine.
double monotonic_s();

}  // namespace outrider::app
