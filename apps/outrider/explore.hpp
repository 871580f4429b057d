#pragma once
// A simulated exploration, from its flags to its record: what `explore` and `sweep` share.

#include <filesystem>
#include <optional>
#include <string>

#include "auction/bid_rules.hpp"
#include "context.hpp"
#include "explorer/mission.hpp"
#include "report/run_record.hpp"
#include "sim/world.hpp"

namespace outrider::app {

/// The flags of `explore` that determine a run; with a seed they determine all of its record but the timing.
struct ExploreOptions {
  std::string world = "office";
  std::optional<double> resolution;
  int robots = 0;
  std::filesystem::path team_file;
  std::string coordinator = "daa", comms = "ideal", sensing = "disc", localization = "perfect", fault;
  std::string starts = "world";
  double odometry_noise = 1.0;  ///< times explorer::OdometryNoise
  double until = 1.0, max_time = 0.0, range_noise = 0.0;
  bool return_home = false, octomap = false;
  auction::BidParameters bids;
};

/// Adds these flags, and WORLD, to a command line.
void add_explore_options(CLI::App& verb, ExploreOptions& o);
/// Adds those of them that live robots know, too: world, team, sensing, coordinator and its parameters.
void add_team_options(CLI::App& verb, ExploreOptions& o);

/// The team that the flags name, on its starts in `world`. Throws InputError.
std::vector<RobotSpec> team_of(const ExploreOptions& o, const sim::World& world, std::uint64_t seed);
/// What the flags mean for a team. Throws InputError.
explorer::MissionSettings mission_settings(const ExploreOptions& o, std::uint64_t seed, const std::vector<RobotSpec>& team);
report::Json world_json(const sim::World& world);
/// What a finished run means for the shell, and for a person.
int exit_code(const report::Json& result);
void print_summary(const report::RunRecord& record, const report::Json& result, const Context& ctx);

/// The world as the simulator takes it: what is unknown in a map is solid. Throws InputError.
sim::World open_exploration_world(const ExploreOptions& o);

/// Throws InputError when the flags do not fit together, or not to the world: what run_exploration would find at its
/// beginning.
void check_exploration(const ExploreOptions& o, const sim::World& world);

/// Runs the mission that the flags ask for in `world`. Throws InputError when they do not fit together. Thread-safe.
report::RunRecord run_exploration(const ExploreOptions& o, const sim::World& world, std::uint64_t seed,
                                  bool record_events, const explorer::MissionProgress& progress);

}  // namespace outrider::app
