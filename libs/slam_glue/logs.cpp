#include "slam_glue/logs.hpp"

#include <fmt/format.h>

#include <array>

#include "slam_glue/gzip.hpp"
#include "slam_glue/log_sources.hpp"
#include "world/error.hpp"

namespace outrider::slam_glue {
namespace {

bool has_suffix(std::string name, std::string_view suffix) {
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  return name.ends_with(suffix);
}

/// By content: a rawlog begins with an object's header, a byte above 127 (0x80 + length) and a class name. Text that is
/// none is told apart by its suffix, for the sake of the error's words.
std::unique_ptr<LogReader::Source> open_source(const std::filesystem::path& file) {
  std::array<char, 16> head{};
  const std::size_t n = GzipReader(file).read(head.data(), head.size());
  const std::string name = file.string();
  if (n == 0) throw InputError(fmt::format("{}: the file is empty; expected a laser log", name));
  const auto length = static_cast<unsigned char>(head[0]);
  const bool object = length >= 0x80 && n > 3 && (head[1] == 'C' || std::string_view(&head[1], 4) == "mrpt");
  if (object || has_suffix(name, ".rawlog")) return open_rawlog(file);
  if (has_suffix(name, ".lcm")) throw InputError(fmt::format("{}: LCM logs cannot be replayed yet", name));
  return open_carmen(file);
}

}  // namespace

LogReader::LogReader(const std::filesystem::path& file) : source_(open_source(file)), info_(source_->inspect()) {
  if (info_.scans == 0)
    throw InputError(fmt::format("{}: no laser scan found; expected an MRPT rawlog or a CARMEN log", file.string()));
}
LogReader::~LogReader() = default;
LogReader::LogReader(LogReader&&) noexcept = default;

const LogInfo& LogReader::info() const { return info_; }

void LogReader::read(const ScanVisitor& on_scan) const {
  std::size_t count = 0;
  source_->read([&](const LogEntry& entry) {
    return on_scan(entry, static_cast<double>(++count) / static_cast<double>(info_.scans));
  });
}

void read_log(const std::filesystem::path& file, const ScanVisitor& on_scan) { LogReader(file).read(on_scan); }

}  // namespace outrider::slam_glue
