#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace outrider::app {
namespace {

constexpr int kBarCells = 24;

std::string minutes(double s) {
  return fmt::format("{}:{:02}", static_cast<int>(s) / 60, static_cast<int>(s) % 60);
}

}  // namespace

Progress::Progress(std::string what, bool quiet)
    : what_(std::move(what)), quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (drawn_) fmt::print(stderr, "\r\x1b[K");
}

double Progress::elapsed_s() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

void Progress::update(double fraction, const std::string& detail) {
  if (quiet_) return;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const auto now = Clock::now();
  const double since_last_s = std::chrono::duration<double>(now - last_).count();
  if (terminal_) {
    if (since_last_s < 0.1) return;
    const int full = static_cast<int>(fraction * kBarCells);
    const std::string left =
        fraction > 0.02 ? ", " + minutes(elapsed_s() * (1.0 - fraction) / fraction) + " left" : std::string();
    fmt::print(stderr, "\r\x1b[K{} [{:#<{}}{:.<{}}] {:3.0f} %  {}{}", what_, "", full, "", kBarCells - full,
               100.0 * fraction, detail, left);
    drawn_ = true;
  } else {
    const int tenth = static_cast<int>(fraction * 10.0);
    if (tenth <= last_tenth_ && since_last_s < 30.0) return;
    last_tenth_ = tenth;
    fmt::print(stderr, "{} {:3.0f} %  {}\n", what_, 100.0 * fraction, detail);
  }
  last_ = now;
}

}  // namespace outrider::app
