#include "sim/arena.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <stdexcept>

#include "world/error.hpp"

namespace outrider::sim {
namespace {

constexpr std::uint64_t kMagic = 0x6f75747269646572;  // "outrider"
constexpr std::size_t kMostRobots = 4096;

}  // namespace

struct Arena::Layout {
  std::uint64_t magic;
  std::uint64_t robots;
  double begin_s;
  Pose2 poses[kMostRobots];  // as many as there are robots
  static std::size_t bytes(std::size_t robots) { return offsetof(Layout, poses) + robots * sizeof(Pose2); }
};

void Arena::create(const std::filesystem::path& file, const std::vector<Pose2>& starts) {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  auto layout = std::make_unique<Layout>();
  layout->magic = kMagic;
  layout->robots = starts.size();
  layout->begin_s = static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  std::copy(starts.begin(), starts.end(), layout->poses);
  const std::size_t bytes = Layout::bytes(starts.size());
  const int fd = open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const bool ok = fd >= 0 && write(fd, layout.get(), bytes) == static_cast<ssize_t>(bytes);
  const int error = errno;
  if (fd >= 0) close(fd);
  if (!ok) throw std::runtime_error(fmt::format("{}: {}", file.string(), std::strerror(error)));
}

void Arena::create_if_absent(const std::filesystem::path& file, const std::vector<Pose2>& starts) {
  if (std::filesystem::exists(file)) return;
  const std::filesystem::path whole = file.string() + fmt::format(".{}", getpid());
  create(whole, starts);
  const bool made = ::link(whole.c_str(), file.c_str()) == 0 || errno == EEXIST;
  const int error = errno;
  unlink(whole.c_str());
  if (!made) throw std::runtime_error(fmt::format("{}: {}", file.string(), std::strerror(error)));
}

Arena::Arena(const std::filesystem::path& file, std::size_t robots) {
  const auto refuse = [&] {
    throw InputError(fmt::format("{}: not the arena of a team of {} robots", file.string(), robots));
  };
  fd_ = open(file.c_str(), O_RDWR | O_CLOEXEC);
  struct stat status {};
  if (fd_ < 0 || fstat(fd_, &status) != 0 || robots > kMostRobots ||
      static_cast<std::size_t>(status.st_size) != Layout::bytes(robots)) {
    if (fd_ >= 0) close(fd_);
    refuse();
  }
  bytes_ = Layout::bytes(robots);
  void* at = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, fd_, 0);
  if (at == MAP_FAILED) {
    close(fd_);
    refuse();
  }
  shared_ = static_cast<Layout*>(at);
  if (shared_->magic == kMagic && shared_->robots == robots) return;
  munmap(at, bytes_);
  close(fd_);
  refuse();
}

Arena::~Arena() {
  munmap(shared_, bytes_);
  close(fd_);
}

double Arena::begin_s() const { return shared_->begin_s; }
Pose2 Arena::pose(RobotId robot) const { return shared_->poses[robot]; }
void Arena::publish(RobotId robot, const Pose2& pose) { shared_->poses[robot] = pose; }

Arena::Lock::Lock(const Arena& arena) : fd_(arena.fd_) {
  while (flock(fd_, LOCK_EX) != 0 && errno == EINTR) {}
}
Arena::Lock::~Lock() { flock(fd_, LOCK_UN); }

ArenaSimulator::ArenaSimulator(const OccupancyGrid& truth, std::vector<RobotSpec> team, RobotId self,
                               const SimOptions& options, const std::filesystem::path& arena)
    : self_(self), arena_(arena, team.size()), robots_(team.size()) {
  const Arena::Lock lock(arena_);
  for (std::size_t r = 0; r < robots_; ++r) team[r].start = arena_.pose(static_cast<RobotId>(r));
  simulator_ = std::make_unique<Simulator>(truth, std::move(team), options);
  for (std::size_t r = 0; r < robots_; ++r)
    if (static_cast<RobotId>(r) != self_) simulator_->kill(static_cast<RobotId>(r));
}

void ArenaSimulator::step() {
  const Arena::Lock lock(arena_);
  for (std::size_t r = 0; r < robots_; ++r)
    if (static_cast<RobotId>(r) != self_) simulator_->place(static_cast<RobotId>(r), arena_.pose(static_cast<RobotId>(r)));
  simulator_->step();
  arena_.publish(self_, simulator_->pose(self_));
}

}  // namespace outrider::sim
