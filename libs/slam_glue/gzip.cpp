#include "slam_glue/gzip.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <cstring>

#include "world/error.hpp"

namespace outrider::slam_glue {
namespace {

constexpr std::size_t kChunk = 1 << 16;
constexpr std::size_t kLongestLine = 4 << 20;  // far above any scan; random bytes without line ends stop here

}  // namespace

void GzipReader::Close::operator()(gzFile_s* f) const { gzclose_r(f); }

GzipReader::GzipReader(const std::filesystem::path& file) : name_(file.string()) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw InputError(fmt::format("{}: no such file", name_));
  if (std::filesystem::is_directory(status)) throw InputError(fmt::format("{}: is a directory", name_));
  file_.reset(gzopen(name_.c_str(), "rb"));
  if (!file_) throw InputError(fmt::format("{}: cannot be read ({})", name_, std::strerror(errno)));
  gzbuffer(file_.get(), kChunk);
}

std::size_t GzipReader::read(char* data, std::size_t size) {
  const int n = gzread(file_.get(), data, static_cast<unsigned>(size));
  int error = Z_OK;
  gzerror(file_.get(), &error);
  // Z_BUF_ERROR after the last byte: the stream ends before its trailer.
  if (n < 0 || (error != Z_OK && error != Z_STREAM_END))
    throw InputError(fmt::format("{}: damaged or truncated gzip file", name_));
  return static_cast<std::size_t>(n);
}

bool GzipReader::refill() {
  buffer_.erase(0, next_);
  next_ = 0;
  const std::size_t old = buffer_.size();
  if (old > kLongestLine)
    throw InputError(
        fmt::format("{}:{}: line longer than {} bytes, not a text log", name_, line_number_ + 1, kLongestLine));
  buffer_.resize(old + kChunk);
  buffer_.resize(old + read(buffer_.data() + old, kChunk));
  return buffer_.size() > old;
}

bool GzipReader::next_line(std::string& line) {
  std::size_t searched = 0;
  for (;;) {
    const std::size_t end = buffer_.find('\n', next_ + searched);
    if (end != std::string::npos) {
      line.assign(buffer_, next_, end - next_);
      next_ = end + 1;
      break;
    }
    searched = buffer_.size() - next_;
    if (!refill()) {
      if (searched == 0) return false;
      line.assign(buffer_, next_);
      next_ = buffer_.size();
      break;
    }
  }
  if (!line.empty() && line.back() == '\r') line.pop_back();
  ++line_number_;
  return true;
}

std::optional<std::uint64_t> gzip_plain_size(const std::filesystem::path& file) {
  try {
    GzipReader reader(file);
    std::string chunk(kChunk, '\0');
    std::uint64_t total = 0;
    while (const std::size_t n = reader.read(chunk.data(), chunk.size())) total += n;
    return total;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace outrider::slam_glue
