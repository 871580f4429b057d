#include "live_team.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

namespace outrider::app {
namespace {

void write_line(int fd, const std::string& line) {
  const std::string text = line + '\n';
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t written = write(fd, text.data() + done, text.size() - done);
    if (written < 0 && errno != EINTR) return;  // the parent is gone, and so will this process be
    done += static_cast<std::size_t>(std::max<ssize_t>(written, 0));
  }
}

}  // namespace

LiveTeam::LiveTeam(std::size_t robots, const GridGeometry& geometry, RunRobot run)
    : geometry_(geometry), run_(std::move(run)), children_(robots), journals_(robots) {}

LiveTeam::~LiveTeam() {
  for (Child& child : children_)
    if (child.pid > 0) ::kill(child.pid, SIGKILL);
  for (std::size_t r = 0; r < children_.size(); ++r)
    if (children_[r].pid > 0) bury(r);
}

void LiveTeam::start(RobotId robot) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error(fmt::format("pipe: {}", std::strerror(errno)));
  const pid_t parent = getpid(), pid = fork();
  if (pid < 0) throw std::runtime_error(fmt::format("fork: {}", std::strerror(errno)));
  if (pid == 0) {
    setpgid(0, 0);  // Ctrl-C goes to the parent, which tells its children once
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(1);
    close(ends[0]);
    for (const Child& other : children_)
      if (other.pipe >= 0) close(other.pipe);
    int code = 1;
    try {
      code = run_(robot, [&](const std::string& line) { write_line(ends[1], line); });
    } catch (const std::exception& e) {
      fmt::print(stderr, "outrider: robot {}: {}\n", robot, e.what());
      std::fflush(stderr);
    }
    _exit(code);
  }
  close(ends[1]);
  fcntl(ends[0], F_SETFL, O_NONBLOCK);
  children_[static_cast<std::size_t>(robot)] = {pid, ends[0], {}};
  journals_[static_cast<std::size_t>(robot)].farewell.reset();
}

void LiveTeam::kill(RobotId robot) {
  if (runs(robot)) ::kill(children_[static_cast<std::size_t>(robot)].pid, SIGKILL);
}

void LiveTeam::interrupt() {
  for (const Child& child : children_)
    if (child.pid > 0) ::kill(child.pid, SIGINT);
}

void LiveTeam::attend(double timeout_s) {
  std::vector<pollfd> pipes;
  for (const Child& child : children_)
    if (child.pipe >= 0) pipes.push_back({child.pipe, POLLIN, 0});
  poll(pipes.data(), pipes.size(), static_cast<int>(timeout_s * 1000.0));
  for (std::size_t r = 0; r < children_.size(); ++r)
    if (children_[r].pipe >= 0) read_from(r);
}

bool LiveTeam::anybody_left() const {
  return std::any_of(children_.begin(), children_.end(), [](const Child& child) { return child.pid > 0; });
}

void LiveTeam::read_from(std::size_t robot) {
  Child& child = children_[robot];
  std::array<char, 65536> buffer;
  ssize_t size = 0;
  while ((size = read(child.pipe, buffer.data(), buffer.size())) > 0) {
    child.rest.append(buffer.data(), static_cast<std::size_t>(size));
    std::size_t begin = 0;
    for (std::size_t end = 0; (end = child.rest.find('\n', begin)) != std::string::npos; begin = end + 1)
      explorer::read_line(std::string_view(child.rest).substr(begin, end - begin), geometry_, journals_[robot]);
    child.rest.erase(0, begin);
  }
  if (size == 0) bury(robot);
}

void LiveTeam::bury(std::size_t robot) {
  Child& child = children_[robot];
  close(child.pipe);
  while (waitpid(child.pid, nullptr, 0) < 0 && errno == EINTR) {}
  child = {};
}

}  // namespace outrider::app
