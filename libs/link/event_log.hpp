#pragma once
// Logs of lcm-logger: a sequence of events, big-endian: EDA1DA01, number, time [us], lengths of channel and data, both.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <span>
#include <vector>

namespace outrider::link {

struct LoggedDatagram {
  std::int64_t number = 0;
  std::int64_t time_us = 0;  ///< the logger's wall clock
  std::string channel;
  std::vector<std::uint8_t> data;
};

/// Reads a log from its beginning. What is damaged is skipped up to the next event and counted; a log that was cut short
/// (the logger was killed) ends at its last whole event.
class EventLogReader {
 public:
  /// Throws InputError when the file cannot be read or does not begin with an event.
  explicit EventLogReader(const std::filesystem::path& file);
  std::optional<LoggedDatagram> next();
  std::uint64_t skipped_bytes() const { return skipped_; }

 private:
  bool find_event();
  std::optional<LoggedDatagram> read_event();

  std::ifstream in_;
  std::uint64_t skipped_ = 0;
};

/// Writes such a log; lcm-logplayer reads it.
class EventLogWriter {
 public:
  /// Throws InputError when the file cannot be written.
  explicit EventLogWriter(const std::filesystem::path& file);
  void write(std::int64_t time_us, std::string_view channel, std::span<const std::uint8_t> data);
  std::uint64_t events() const { return number_; }
  bool good() const { return out_.good(); }

 private:
  std::ofstream out_;
  std::uint64_t number_ = 0;
};

}  // namespace outrider::link
