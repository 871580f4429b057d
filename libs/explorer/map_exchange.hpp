#pragma once
// How maps catch up after silence: whoever hears of a different map says what it has, and pulls what it misses.

#include <map>
#include <vector>

#include "world/messages.hpp"
#include "world/team_map.hpp"

namespace outrider::explorer {

/// Anti-entropy between the maps of a team, beside the MapUpdates of the normal case. Every status carries the hash of
/// the sender's map. A robot that hears another hash than its own broadcasts a digest: weight and hash of each tile. Who
/// hears a digest requests the tiles that are heavier there, or as heavy and different. Tiles are broadcast, merging is
/// idempotent, so loss, order, repetition and any mixture of old and new do no harm, and everybody profits. Of two
/// different tiles the lighter side pulls first and then outweighs the other: both end with the union. Who knows more of
/// a tile than was just broadcast broadcasts its own a little later, robot by robot, unless another did so meanwhile.
///
/// A state machine without clock or socket: time comes in, messages come out. All times are durations from receipt.
class MapExchange {
 public:
  struct Settings {
    double digest_period = 0.5;   ///< between two digests of one robot [s]
    double request_again = 0.5;   ///< between two requests for the same tile [s]
    double tiles_per_s = 200.0;   ///< pace of tiles sent
    double stagger = 0.05;        ///< who adds to a tile waits that long times its number modulo 8 [s]
    double silent_after = 2.0;    ///< a robot not heard for so long is gone [s]
  };
  MapExchange(RobotId self, TeamMap& map, const Settings& settings) : self_(self), map_(map), settings_(settings) {}

  /// Takes notice of a message; merges tiles into the map. Other messages are ignored.
  void hear(const Message& message, double now_s);
  /// What is to be sent now. `now_s` never decreases.
  std::vector<Message> speak(double now_s);
  /// Every robot heard lately had the same map as this one when last heard.
  bool settled(double now_s) const;

 private:
  struct Peer {
    double heard_s = 0.0;
    bool differs = false;
  };
  /// A tile that is to be sent.
  struct Wanted {
    std::uint32_t tile;
    double due_s;
    bool asked_for;  ///< or added unasked
  };
  void merge(const MapTile& tile, double now_s);
  void want(std::uint32_t tile, double due_s, bool asked_for);
  void compare(const MapDigest& digest, double now_s);
  void say_what_we_have(std::vector<Message>& out) const;

  RobotId self_;
  TeamMap& map_;
  Settings settings_;
  std::map<RobotId, Peer> peers_;
  std::map<std::uint32_t, double> requested_;  // when each tile was last asked for [s]
  std::vector<TileRequest> requests_;          // to be sent
  std::vector<Wanted> wanted_;                 // oldest first, no tile twice
  bool digest_due_ = false;
  double digest_s_ = -1e9;                     // of the last digest
  double paced_s_ = 0.0;                       // tiles are sent up to here
};

}  // namespace outrider::explorer
