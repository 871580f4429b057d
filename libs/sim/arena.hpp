#pragma once
// Where the simulated bodies of several processes on one machine meet: a small file that they all map.

#include <filesystem>
#include <memory>
#include <vector>

#include "sim/simulator.hpp"

namespace outrider::sim {

/// True poses of a team, shared. A robot locks the arena while it moves, so that moves follow each other and no two
/// bodies overlap; a process that dies gives the lock back and leaves its body where it stood.
class Arena {
 public:
  /// Makes `file` an arena of bodies at `starts`; the time of all robots begins now. Throws std::runtime_error.
  static void create(const std::filesystem::path& file, const std::vector<Pose2>& starts);
  /// The same when there is no such file; of several processes one makes it.
  static void create_if_absent(const std::filesystem::path& file, const std::vector<Pose2>& starts);
  /// Throws InputError when `file` is no arena of `robots` bodies.
  Arena(const std::filesystem::path& file, std::size_t robots);
  ~Arena();
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  /// Of CLOCK_MONOTONIC, which is the same in all processes of a machine [s].
  double begin_s() const;
  Pose2 pose(RobotId robot) const;
  void publish(RobotId robot, const Pose2& pose);

  class Lock {
   public:
    explicit Lock(const Arena& arena);
    ~Lock();
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;

   private:
    int fd_;
  };

 private:
  struct Layout;
  Layout* shared_ = nullptr;
  std::size_t bytes_ = 0;
  int fd_ = -1;
};

/// One robot of a team, simulated in this process; the others' bodies are where the arena says.
class ArenaSimulator {
 public:
  /// Starts where the arena has the robot: at its start, or where it died before.
  ArenaSimulator(const OccupancyGrid& truth, std::vector<RobotSpec> team, RobotId self, const SimOptions& options,
                 const std::filesystem::path& arena);

  void step();
  Body& body() { return simulator_->body(self_); }
  double path_m() const { return simulator_->path_m(self_); }
  double begin_s() const { return arena_.begin_s(); }

 private:
  RobotId self_;
  Arena arena_;
  std::unique_ptr<Simulator> simulator_;
  std::size_t robots_;
};

}  // namespace outrider::sim
