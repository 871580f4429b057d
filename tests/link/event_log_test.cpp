#include "link/event_log.hpp"

#include <gtest/gtest.h>

#include "world/error.hpp"

namespace outrider::link {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

class EventLog : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "outrider-log-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    dir_ = pattern;
    file = dir_ / "run.lcm";
    EventLogWriter writer(file);
    for (int k = 0; k < 10; ++k) writer.write(1000 + k, "CHANNEL_" + std::to_string(k), Bytes(static_cast<std::size_t>(k * 20), static_cast<std::uint8_t>(k)));
  }
  void TearDown() override { fs::remove_all(dir_); }

  std::vector<LoggedDatagram> read() {
    EventLogReader reader(file);
    std::vector<LoggedDatagram> events;
    while (auto event = reader.next()) events.push_back(std::move(*event));
    skipped = reader.skipped_bytes();
    return events;
  }
  void patch(std::streamoff at, const std::string& bytes) {
    std::fstream out(file, std::ios::binary | std::ios::in | std::ios::out);
    out.seekp(at);
    out << bytes;
  }

  fs::path file;
  std::uint64_t skipped = 0;

 private:
  fs::path dir_;
};

TEST_F(EventLog, ComesBackAsItWas) {
  const auto events = read();
  ASSERT_EQ(events.size(), 10U);
  EXPECT_EQ(events[3].number, 3);
  EXPECT_EQ(events[3].time_us, 1003);
  EXPECT_EQ(events[3].channel, "CHANNEL_3");
  EXPECT_EQ(events[3].data, Bytes(60, 3));
  EXPECT_EQ(skipped, 0U);
}

TEST_F(EventLog, OneCutShortEndsAtItsLastWholeEvent) {
  for (const std::uintmax_t cut : {1U, 20U, 200U}) {
    fs::resize_file(file, fs::file_size(file) - cut);
    EXPECT_GE(read().size(), 8U);
  }
}

TEST_F(EventLog, DamageCostsTheEventsItHitsOnly) {
  patch(2 * 37 + 20, "xxxx");  // inside the third event's sync word
  const auto events = read();
  EXPECT_EQ(events.size(), 9U);
  EXPECT_GT(skipped, 0U);
}

TEST_F(EventLog, ADeclaredLengthIsNotBelieved) {
  patch(24, std::string("\x0F\xFF\xFF\xFF", 4));  // 256 MB of data in the first event
  EXPECT_EQ(read().size(), 9U);
  patch(20, std::string("\xFF\xFF\xFF\xFF", 4));
  EXPECT_EQ(read().size(), 9U);
}

TEST_F(EventLog, AFileThatIsNoLogIsRefused) {
  patch(0, "nonsense");
  EXPECT_THROW(EventLogReader{file}, InputError);
  EXPECT_THROW(EventLogReader{file.parent_path()}, InputError);
}

}  // namespace
}  // namespace outrider::link
