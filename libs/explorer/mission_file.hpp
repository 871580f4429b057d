#pragma once
// Missions on topological maps as files. docs/missions.md has the format.

#include <filesystem>
#include <string>

#include "decision/topo_mission.hpp"

namespace outrider::explorer {

/// Reads `waypoints: [{id, x, y, theta, state}], paths: [{from, to, cost, deviation: {id: p}}], robots: [{name, at}],
/// goals: [ids]` (YAML), or the same with `graph: FILE.graph` instead of waypoints and paths. Throws InputError naming
/// file, line, key and what was expected: unknown or double keys and ids, costs that are not above 0, deviations that
/// are no distribution or have another outcome likelier than the target.
decision::TopoMission read_mission(const std::filesystem::path& path);

/// The map of a mission file (robots and goals may be missing), or of a `.graph` file.
decision::TopologicalMap read_topological_map(const std::filesystem::path& path);

/// The text of a mission file; read_mission() of it gives the same mission. Robots' own maps are not written.
std::string mission_text(const decision::TopoMission& mission);

/// Reads a patrolling_sim `.graph`: vertices in cells with the origin at the bottom left, costs in cells; both become
/// metres. Throws InputError naming file and line.
decision::TopologicalMap read_graph(const std::filesystem::path& path);

}  // namespace outrider::explorer
