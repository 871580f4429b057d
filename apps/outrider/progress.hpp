#pragma once

#include <chrono>
#include <string>

namespace outrider::app {

/// One line on stderr that tells how far a long job is. On a terminal it is redrawn in place, at most ten times a
/// second; in a pipe it becomes one plain line per 10 % or 30 s, whichever comes first; quiet: nothing at all.
class Progress {
 public:
  Progress(std::string what, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `fraction` in [0, 1]; `detail` is shown behind it ("412 scans, 3100 scans/s").
  void update(double fraction, const std::string& detail);
  double elapsed_s() const;

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point last_ = begin_;
  int last_tenth_ = 0;
};

}  // namespace outrider::app
