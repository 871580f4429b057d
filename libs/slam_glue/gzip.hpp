#pragma once
// Internal: files that may or may not be gzip-compressed, read strictly.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

struct gzFile_s;

namespace outrider::slam_glue {

/// Reads a plain or gzip file. Throws InputError naming the file when it is missing, a directory, or damaged.
class GzipReader {
 public:
  explicit GzipReader(const std::filesystem::path& file);

  /// Up to `size` bytes; fewer only at the end.
  std::size_t read(char* data, std::size_t size);
  /// The next line without its end (LF or CRLF); false at the end. Lines are counted from 1.
  bool next_line(std::string& line);
  std::size_t line_number() const { return line_number_; }

 private:
  struct Close {
    void operator()(gzFile_s* f) const;
  };
  bool refill();

  std::string name_;
  std::unique_ptr<gzFile_s, Close> file_;
  std::string buffer_;
  std::size_t next_ = 0;
  std::size_t line_number_ = 0;
};

/// Size when unpacked, or none when the file is damaged or cannot be read. Reads it all.
std::optional<std::uint64_t> gzip_plain_size(const std::filesystem::path& file);

}  // namespace outrider::slam_glue
