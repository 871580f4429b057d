#pragma once

#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "bench.hpp"

namespace outrider::app {

/// What a sweep has run already: one line of JSON a run, appended as runs end, so that a killed sweep goes on where it
/// was. A last line that was cut short is dropped.
class SweepJournal {
 public:
  /// Opens or creates the file, for one process at a time. Throws InputError when another sweep is writing it, or when
  /// it is no journal.
  explicit SweepJournal(const std::filesystem::path& file);

  std::size_t size() const { return outcomes_.size(); }
  std::optional<Outcome> find(const std::string& id) const;
  /// Thread-safe beside itself and find(). Throws std::runtime_error when it cannot be written.
  void append(const std::string& id, const Outcome& outcome);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  void read(const std::string& text);

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::mutex mutex_;                          // guards file_
  std::map<std::string, Outcome> outcomes_;   // as found when opened
};

}  // namespace outrider::app
