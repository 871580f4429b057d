#pragma once
// One CARMEN log as several shorter ones, as if so many robots had driven it.

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "slam_glue/gzip.hpp"

namespace outrider::test {

/// Splits by scans into `parts` equal stretches, each longer by `overlap` (share of a stretch) at its end. Parameters
/// and comments go into every part. Files are `stem`-1.clf and so on.
inline std::vector<std::filesystem::path> split_log(const std::filesystem::path& log, int parts, double overlap,
                                                    const std::filesystem::path& stem) {
  std::vector<std::string> lines;
  std::vector<std::size_t> scan_lines;
  {
    slam_glue::GzipReader reader(log);
    for (std::string line; reader.next_line(line);) {
      if (line.starts_with("FLASER") || line.find("LASER1") < 12) scan_lines.push_back(lines.size());
      lines.push_back(line);
    }
  }
  std::vector<std::filesystem::path> files;
  const double stretch = static_cast<double>(scan_lines.size()) / parts;
  for (int part = 0; part < parts; ++part) {
    files.push_back(stem.string() + "-" + std::to_string(part + 1) + ".clf");
    std::ofstream out(files.back());
    const auto first = static_cast<std::size_t>(stretch * part);
    const auto last = std::min(scan_lines.size(), static_cast<std::size_t>(stretch * (part + 1 + overlap)));
    const std::size_t begin = part == 0 ? 0 : scan_lines[first];
    const std::size_t end = last == scan_lines.size() ? lines.size() : scan_lines[last];
    for (std::size_t i = 0; i < end; ++i)
      if (i >= begin || lines[i].starts_with("PARAM") || lines[i].starts_with("#")) out << lines[i] << '\n';
  }
  return files;
}

}  // namespace outrider::test
