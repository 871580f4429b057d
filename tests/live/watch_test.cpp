// The live page, served and in a real browser (Debian's chromium and chromium-driver, where they are installed).

#include <gtest/gtest.h>
#include <httplib.h>

#include <cmath>
#include <cstdlib>

#include "live/rooms.hpp"

namespace outrider::test {
namespace {

constexpr int kPage = 17680, kDriver = 17681;

bool installed(const char* program) { return std::system((std::string("command -v ") + program + " >/dev/null 2>&1").c_str()) == 0; }

/// A child process that ends with its owner.
class Process {
 public:
  Process(const Args& argv, const fs::path& cwd) : pid_(fork()) {
    if (pid_ != 0) return;
    setpgid(0, 0);
    std::vector<char*> words;
    for (const std::string& word : argv) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    const int null = open("/dev/null", O_RDWR);
    for (const int fd : {0, 1, 2}) dup2(null, fd);
    if (chdir(cwd.c_str()) == 0) execvp(words[0], words.data());
    _exit(127);
  }
  ~Process() {
    kill(-pid_, SIGTERM);
    for (int k = 0; k < 100 && waitpid(pid_, nullptr, WNOHANG) == 0; ++k) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    kill(-pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

 private:
  pid_t pid_;
};

class Watch : public SystemTest {
 protected:
  void SetUp() override {
    if (!private_network()) GTEST_SKIP() << "this kernel gives no network namespace";
    SystemTest::SetUp();
    team_ = std::make_unique<Process>(Args{OUTRIDER_BINARY, "team", "office", "--robots", "4", "--speed", "2", "-q"}, dir);
    watch_ = std::make_unique<Process>(Args{OUTRIDER_BINARY, "watch", "--port", std::to_string(kPage), "-q"}, dir);
  }
  void TearDown() override {
    watch_.reset();
    team_.reset();
    SystemTest::TearDown();
  }

  /// The newest state that the server has, once `ready` likes it.
  static Json state_when(const std::function<bool(const Json&)>& ready) {
    httplib::Client client("127.0.0.1", kPage);
    for (int k = 0; k < 200; ++k) {
      const auto response = client.Get("/state");
      const auto at = response ? response->body.find("data: ") : std::string::npos;
      if (at != std::string::npos) {
        const std::string line = response->body.substr(at + 6, response->body.find('\n', at) - at - 6);
        if (Json state = Json::parse(line, nullptr, false); !state.is_discarded() && ready(state)) return state;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    ADD_FAILURE() << "the page shows nothing of the kind";
    return {};
  }

 private:
  std::unique_ptr<Process> team_, watch_;
};

TEST_F(Watch, ALateListenerHasTheWholePictureSoon) {
  const Json state = state_when([](const Json& s) {
    return s.contains("robots") && s["robots"].size() == 4 && s["known"].get<double>() > 0.05 && s["auctions"].size() > 1 &&
           std::all_of(s["robots"].begin(), s["robots"].end(), [](const Json& r) { return r.contains("pose") && r["hears"].size() == 3; });
  });
  ASSERT_TRUE(state.is_object());
  EXPECT_EQ(state["team"]["robots"].size(), 4U);
  httplib::Client client("127.0.0.1", kPage);
  const auto page = client.Get("/");
  ASSERT_TRUE(page);
  EXPECT_NE(page->body.find("class MapView"), std::string::npos) << "the report's drawing code";
  std::size_t events = 0;
  client.Get("/events", [&](const char* data, std::size_t size) {
    events += std::string_view(data, size).find("event: ") != std::string_view::npos;
    return events < 20;
  });
  EXPECT_GE(events, 20U);
}

TEST_F(Watch, ABrowserSeesFourRobotsMove) {
  if (!installed("chromedriver") || !installed("chromium")) GTEST_SKIP() << "chromium and chromedriver are not installed";
  const Process driver({"chromedriver", "--port=" + std::to_string(kDriver)}, dir);
  httplib::Client client("127.0.0.1", kDriver);
  client.set_read_timeout(60);
  const Json wanted{{"capabilities", {{"alwaysMatch", {{"goog:chromeOptions", {{"args", {"--headless=new", "--no-sandbox", "--disable-gpu",
      "--disable-dev-shm-usage", "--window-size=1280,1200", "--user-data-dir=" + (dir / "profile").string()}}}}}}}}};
  httplib::Result created(nullptr, httplib::Error::Unknown);
  for (int k = 0; k < 100 && !created; ++k) {
    created = client.Post("/session", wanted.dump(), "application/json");
    if (!created) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  ASSERT_TRUE(created);
  ASSERT_EQ(created->status, 200) << created->body;
  const std::string session = "/session/" + Json::parse(created->body)["value"]["sessionId"].get<std::string>();
  const Json page{{"url", "http://127.0.0.1:" + std::to_string(kPage) + "/"}};
  ASSERT_EQ(client.Post((session + "/url").c_str(), page.dump(), "application/json")->status, 200);
  const Json script{{"args", Json::array()},
                    {"script", "return live.view ? live.view.data.robots.map((r) => [r.path.x[0], r.path.y[0]]) : []"}};
  const auto positions = [&] {
    const auto answer = client.Post((session + "/execute/sync").c_str(), script.dump(), "application/json");
    return answer ? Json::parse(answer->body)["value"] : Json();
  };
  Json first;
  std::vector<bool> moved(4, false);
  for (int k = 0; k < 200 && std::count(moved.begin(), moved.end(), true) < 4; ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const Json now = positions();
    if (!now.is_array() || now.size() != 4 || std::any_of(now.begin(), now.end(), [](const Json& p) { return !p[0].is_number(); })) continue;
    if (first.is_null()) first = now;
    for (std::size_t r = 0; r < 4; ++r)
      moved[r] = moved[r] || std::hypot(now[r][0].get<double>() - first[r][0].get<double>(), now[r][1].get<double>() - first[r][1].get<double>()) > 0.3;
  }
  EXPECT_EQ(std::count(moved.begin(), moved.end(), true), 4) << first.dump();
  if (const char* folder = std::getenv("OUTRIDER_SHOW")) {
    std::this_thread::sleep_for(std::chrono::seconds(6));
    const auto shot = client.Get((session + "/screenshot").c_str());
    if (shot) spill(fs::path(folder) / "watch.png.base64", Json::parse(shot->body)["value"].get<std::string>());
  }
  client.Delete(session.c_str());
}

}  // namespace
}  // namespace outrider::test
