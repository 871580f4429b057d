#pragma once
// What a live robot leaves behind, as lines of text: whoever holds the lines of all robots can write the report, and a
// robot that was killed has told everything up to its last line.

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "explorer/mission.hpp"
#include "link/lcm_bus.hpp"

namespace outrider::explorer {

/// Takes one line, without its end.
using LineSink = std::function<void(const std::string&)>;

/// Why a robot stopped.
enum class LiveEnd { kTeamDone, kTimeout, kInterrupted };

/// What it says in the end.
struct LiveFarewell {
  LiveEnd end = LiveEnd::kInterrupted;
  double t = 0.0;                 ///< [s]
  double done_s = 0.0;            ///< when this robot last had something to explore
  double path_m = 0.0;
  double equal_s = 0.0;           ///< when all maps it hears of were last different from its own
  std::uint64_t map_hash = 0;
  link::LcmBusCounters bus;
  link::RejectionCounters rejections;
  OccupancyGrid map;
  std::vector<Left> left;
};

/// One robot's journal.
struct RobotJournal {
  struct Entry {
    double t;
    Pose2 pose;
    std::vector<std::uint32_t> cells;  ///< seen for the first time by the own sensor
  };
  std::vector<Entry> entries;
  std::vector<std::string> events;     ///< lines of events.jsonl
  std::optional<LiveFarewell> farewell;  ///< none: it was killed
};

/// "P t x y theta index+length ..." or "E {...}": written as things happen.
std::string entry_line(double t, const Pose2& pose, const std::vector<std::uint32_t>& cells);
inline std::string event_line(const std::string& json) { return "E " + json; }
/// The last lines.
void write_farewell(const LiveFarewell& farewell, const LineSink& sink);

/// Adds a line to a journal; lines that are cut or make no sense are left out.
void read_line(std::string_view line, const GridGeometry& geometry, RobotJournal& journal);

/// The team's mission as a referee who knows the truth sees it. Robots without farewell count as killed.
MissionResult gather(const OccupancyGrid& truth, const std::vector<RobotSpec>& team,
                     const std::vector<RobotJournal>& journals);

}  // namespace outrider::explorer
