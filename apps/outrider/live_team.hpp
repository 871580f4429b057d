#pragma once
// The robot processes of a live team on this machine.

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "explorer/journal.hpp"

namespace outrider::app {

/// Starts robots as children, reads their journals through pipes, and sees to it that none outlives this object. A child
/// ends by itself when this process dies, however it does. Single-threaded.
class LiveTeam {
 public:
  /// Runs one robot in a child process, writing its journal line by line; returns its exit code.
  using RunRobot = std::function<int(RobotId, const explorer::LineSink&)>;
  LiveTeam(std::size_t robots, const GridGeometry& geometry, RunRobot run);
  ~LiveTeam();  ///< kills whoever still runs

  void start(RobotId robot);
  void kill(RobotId robot);  ///< SIGKILL: it says nothing any more
  void interrupt();          ///< everybody saves and leaves

  /// Waits up to `timeout_s` for something to read, reads it, and buries the dead.
  void attend(double timeout_s);
  bool anybody_left() const;
  bool runs(RobotId robot) const { return children_[static_cast<std::size_t>(robot)].pid > 0; }
  std::vector<explorer::RobotJournal>& journals() { return journals_; }

 private:
  struct Child {
    pid_t pid = -1;
    int pipe = -1;
    std::string rest;  ///< the beginning of a line
  };
  void read_from(std::size_t robot);
  void bury(std::size_t robot);

  GridGeometry geometry_;
  RunRobot run_;
  std::vector<Child> children_;
  std::vector<explorer::RobotJournal> journals_;
};

}  // namespace outrider::app
