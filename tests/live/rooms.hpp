#pragma once
// Four rooms and four unlike robots for the tests of live teams.

#include "link/private_network.hpp"
#include "system/run.hpp"

namespace outrider::test {

/// Moves the test program, once, into a network of its own.
inline bool private_network() {
  static const bool there = link::enter_private_network();
  return there;
}

inline void write_rooms_and_team(const fs::path& dir) {
  spill(dir / "rooms.txt", R"(resolution: 0.5
map:
##########################
#..........#.............#
#.0.1......#.............#
#..........#.............#
#........................#
#........................#
#.2.3......#.............#
#..........#.............#
#####..##########..#######
#..........#.............#
#..........#.............#
#..........#.............#
##########################
)");
  spill(dir / "team.yaml",
        "robots:\n"
        "  - {name: a, speed: 0.6, range: 2.5, radius: 0.2}\n  - {name: b, speed: 0.8, range: 3, radius: 0.2}\n"
        "  - {name: c, speed: 0.6, range: 2.5, radius: 0.2}\n  - {name: d, speed: 0.5, range: 2, radius: 0.2}\n");
}

}  // namespace outrider::test
