// A keyed team explores while somebody throws everything at it.

#include <gtest/gtest.h>
#include <signal.h>

#include <random>

#include "link/codec.hpp"
#include "link/lc02.hpp"
#include "link/multicast.hpp"
#include "link/random_message.hpp"
#include "live/rooms.hpp"

namespace outrider::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Random bytes, mutated and replayed real messages, forged ids, declared lengths, liblcm's two killers.
class Attacker {
 public:
  explicit Attacker(std::uint64_t seed) : random_(seed) {
    std::string why;
    socket_ = link::MulticastSocket::open(link::MulticastUrl::parse("udpm://239.255.76.67:7667?ttl=0"), why);
  }

  void attack(int packets) {
    listen();
    for (int k = 0; k < packets; ++k) socket_->send(next());
    sent += static_cast<std::size_t>(packets);
  }
  std::size_t sent = 0;

 private:
  std::uint64_t below(std::uint64_t n) { return random_() % n; }

  void listen() {
    Bytes buffer(2000);
    while (const auto size = socket_->receive(buffer))
      if (overheard_.size() < 512) overheard_.emplace_back(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(*size));
      else overheard_[below(512)].assign(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(*size));
  }

  Bytes next() {
    switch (below(6)) {
      case 0: return noise(below(1500));
      case 1: return killer();
      case 2: return overheard_.empty() ? noise(40) : overheard_[below(overheard_.size())];  // a replay
      case 3: return forged();
      default: return mutated();
    }
  }
  Bytes noise(std::size_t size) {
    Bytes bytes(size);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random_());
    return bytes;
  }
  Bytes killer() {
    Bytes bytes{'L', 'C', '0', '3', 0, 0, 0, 1, 0, 0, 16, 0, 0xFF, 0xFF, 0xFF, 0xF0, 0, 1, 0, 2};
    if (below(2)) bytes = {'L', 'C', '0', '3', 0, 0, 0, 1, 0, 0, 16, 0, 0, 0, 0, 0, 0, 0, 0, 2, 'X', 0};
    return bytes;
  }
  Bytes forged() {
    const auto robot = static_cast<RobotId>(below(5));
    const Message message = MessageSource(random_()).draw(below(MessageSource::kKinds), robot);
    const link::Envelope envelope{0, static_cast<std::int64_t>(random_() >> 1U), static_cast<std::int64_t>(random_() >> 1U), 77, robot};
    return link::make_lc02(1, link::channel_of(message), link::encode(envelope, message));
  }
  Bytes mutated() {
    Bytes bytes = overheard_.empty() ? Bytes() : overheard_[below(overheard_.size())];
    if (bytes.empty()) return forged();  // nothing heard yet, or an empty datagram of our own
    for (std::uint64_t flips = 1 + below(8); flips > 0; --flips) bytes[below(bytes.size())] = below(2) ? 0xFF : static_cast<std::uint8_t>(random_());
    if (below(6) == 0) bytes.resize(below(1500));
    return bytes;
  }

  std::mt19937_64 random_;
  std::optional<link::MulticastSocket> socket_;
  std::vector<Bytes> overheard_;
};

/// Largest resident set of the processes whose working folder is `dir` [kB].
long largest_rss(const fs::path& dir) {
  long most = 0;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::error_code error;
    if (fs::read_symlink(entry.path() / "cwd", error) != dir || error) continue;
    const std::string status = slurp(entry.path() / "status");
    const auto at = status.find("VmRSS:");
    if (at != std::string::npos) most = std::max(most, std::stol(status.substr(at + 6)));
  }
  return most;
}

class Hostile : public SystemTest {
 protected:
  void SetUp() override {
    if (!private_network()) GTEST_SKIP() << "this kernel gives no network namespace";
    SystemTest::SetUp();
    spill(dir / "key", std::string(32, 'k'));
  }

  /// 2000 packets a second against four robots until they are done.
  void besiege(const std::string& speed, double at_least_s, double most_s) {
    const pid_t team = fork();
    if (team == 0) {
      const int out = open((dir / "out.json").c_str(), O_WRONLY | O_CREAT, 0600);
      dup2(out, STDOUT_FILENO);
      if (chdir(dir.c_str()) == 0)
        execl(OUTRIDER_BINARY, "outrider", "team", "office", "--robots", "4", "--key", "key", "--run", "77", "--speed",
              speed.c_str(), "--json", "-q", nullptr);
      _exit(127);
    }
    Attacker attacker(1);
    const auto begin = std::chrono::steady_clock::now();
    long early_kb = 0, late_kb = 0;
    int status = 0;
    double elapsed_s = 0.0;
    pid_t ended = 0;
    while ((ended = waitpid(team, &status, WNOHANG)) == 0 && elapsed_s < most_s) {
      attacker.attack(20);
      elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      if (attacker.sent % 2000 == 0) (elapsed_s < 2.5 ? early_kb : late_kb) = largest_rss(dir);
      std::this_thread::sleep_until(begin + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                                std::chrono::duration<double>(static_cast<double>(attacker.sent) / 2000.0)));
    }
    if (ended == 0) {  // its robots end with it
      kill(team, SIGKILL);
      waitpid(team, &status, 0);
    }
    ASSERT_TRUE(WIFEXITED(status)) << (ended == 0 ? "still running" : "crashed");
    EXPECT_EQ(WEXITSTATUS(status), 0);
    const Json result = Json::parse(slurp(dir / "out.json"))["result"];
    EXPECT_EQ(result["status"], "explored");
    EXPECT_TRUE(result["maps_equal"].get<bool>());
    for (const auto& [name, link] : result["link"].items()) {
      ASSERT_TRUE(link.is_object()) << name << " died";
      for (const char* reason : {"no LCM message", "fragment", "unknown channel", "wrong key", "replayed"})
        EXPECT_GT(link["rejected"].value(reason, 0), 0) << name << ": " << reason;
    }
    EXPECT_GE(elapsed_s, at_least_s);
    EXPECT_LT(late_kb, early_kb + 32 * 1024) << "memory grows";
    fmt_print(attacker.sent, elapsed_s, early_kb, late_kb, result["link"]);
  }

 private:
  void fmt_print(std::size_t sent, double seconds, long early_kb, long late_kb, const Json& link) {
    RecordProperty("packets", static_cast<int>(sent));
    RecordProperty("seconds", static_cast<int>(seconds));
    RecordProperty("rss_early_kb", static_cast<int>(early_kb));
    RecordProperty("rss_late_kb", static_cast<int>(late_kb));
    if (std::getenv("OUTRIDER_SHOW") != nullptr) std::fprintf(stderr, "%zu packets in %.1f s, rss %ld -> %ld kB\n%s\n", sent, seconds, early_kb, late_kb, link.dump(1).c_str());
  }
};

TEST_F(Hostile, TwoThousandPacketsASecondDoNoHarm) { besiege("15", 0.0, 60.0); }

// The soak: test_live --gtest_also_run_disabled_tests --gtest_filter=*Soak*, with OUTRIDER_SHOW=1 for the figures.
TEST_F(Hostile, DISABLED_Soak) { besiege("1", 60.0, 600.0); }

}  // namespace
}  // namespace outrider::test
