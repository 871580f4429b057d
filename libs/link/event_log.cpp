#include "link/event_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>

#include "world/error.hpp"

namespace outrider::link {
namespace {

constexpr std::uint32_t kSync = 0xEDA1DA01;
constexpr std::uint32_t kLongestChannel = 63, kMostData = 1U << 28U;  // LCM's own limits

template <class T>
std::optional<T> read_number(std::istream& in) {
  std::array<char, sizeof(T)> bytes;
  if (!in.read(bytes.data(), bytes.size())) return std::nullopt;
  std::uint64_t value = 0;
  for (const char byte : bytes) value = value << 8U | static_cast<std::uint8_t>(byte);
  return static_cast<T>(value);
}

void write_number(std::ostream& out, std::uint64_t value, unsigned bytes) {
  for (unsigned k = bytes; k-- > 0;) out.put(static_cast<char>(value >> (8U * k)));
}

}  // namespace

EventLogReader::EventLogReader(const std::filesystem::path& file) : in_(file, std::ios::binary) {
  if (!std::filesystem::is_regular_file(file) || !in_)
    throw InputError(fmt::format("{}: cannot read the log", file.string()));
  const auto sync = read_number<std::uint32_t>(in_);
  if (sync != kSync)
    throw InputError(fmt::format("{}: not an LCM log: it does not begin with an event (ED A1 DA 01)", file.string()));
  in_.seekg(0);
}

std::optional<LoggedDatagram> EventLogReader::next() {
  while (find_event()) {
    const auto at = in_.tellg();
    if (auto event = read_event()) return event;
    in_.clear();
    in_.seekg(at);
    skipped_ += 4;
  }
  return std::nullopt;
}

/// Reads up to the end of the next sync word. False at the end of the file.
bool EventLogReader::find_event() {
  std::uint32_t window = 0;
  for (std::uint64_t read = 1;; ++read) {
    const int byte = in_.get();
    if (byte == std::char_traits<char>::eof()) {
      skipped_ += read - 1;
      return false;
    }
    window = window << 8U | static_cast<std::uint32_t>(byte);
    if (read >= 4 && window == kSync) {
      skipped_ += read - 4;
      return true;
    }
  }
}

std::optional<LoggedDatagram> EventLogReader::read_event() {
  constexpr std::size_t kPiece = 65536;  // memory grows with what is there, not with what is declared
  const auto number = read_number<std::int64_t>(in_), time_us = read_number<std::int64_t>(in_);
  const auto channel_length = read_number<std::uint32_t>(in_), data_length = read_number<std::uint32_t>(in_);
  if (!number || !time_us || !channel_length || !data_length) return std::nullopt;
  if (*channel_length > kLongestChannel || *data_length > kMostData) return std::nullopt;
  LoggedDatagram event{*number, *time_us, std::string(*channel_length, '\0'), {}};
  in_.read(event.channel.data(), static_cast<std::streamsize>(event.channel.size()));
  for (std::size_t left = *data_length; left > 0 && in_;) {
    const std::size_t piece = std::min(left, kPiece), before = event.data.size();
    event.data.resize(before + piece);
    in_.read(reinterpret_cast<char*>(event.data.data() + before), static_cast<std::streamsize>(piece));
    left -= piece;
  }
  return in_ ? std::optional(std::move(event)) : std::nullopt;
}

EventLogWriter::EventLogWriter(const std::filesystem::path& file) : out_(file, std::ios::binary) {
  if (!out_) throw InputError(fmt::format("{}: cannot write the log", file.string()));
}

void EventLogWriter::write(std::int64_t time_us, std::string_view channel, std::span<const std::uint8_t> data) {
  write_number(out_, kSync, 4);
  write_number(out_, number_++, 8);
  write_number(out_, std::bit_cast<std::uint64_t>(time_us), 8);
  write_number(out_, channel.size(), 4);
  write_number(out_, data.size(), 4);
  out_.write(channel.data(), static_cast<std::streamsize>(channel.size()));
  out_.write(reinterpret_cast<const char*>(data.data()), static_cast<std::streamsize>(data.size()));
}

}  // namespace outrider::link
