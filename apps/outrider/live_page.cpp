#include "live_page.hpp"

#include <fmt/format.h>
#include <httplib.h>

#include <chrono>

#include "report/html.hpp"
#include "world/error.hpp"

namespace outrider::app {
namespace {

constexpr int kMostBrowsers = 24;   // each holds a thread
constexpr double kKeepAlive = 1.0;  // [s]: a browser that is gone shows

}  // namespace

void LiveBoard::set(const std::string& name, const std::string& event, const std::string& data) {
  const std::lock_guard lock(mutex_);
  items_[name] = {++version_, fmt::format("event: {}\ndata: {}\n\n", event, data)};
  news_.notify_all();
}

std::string LiveBoard::newer_than(std::uint64_t& version, double timeout_s) const {
  std::unique_lock lock(mutex_);
  news_.wait_for(lock, std::chrono::duration<double>(timeout_s), [&] { return version_ > version || closed_; });
  std::string text;
  if (const auto state = items_.find("state"); state != items_.end() && state->second.version > version) text = state->second.event;
  for (const auto& [name, item] : items_)
    if (name != "state" && item.version > version) text += item.event;
  version = version_;
  return text;
}

void LiveBoard::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  news_.notify_all();
}

struct LivePage::Server {
  httplib::Server http;
  std::atomic<int> browsers{0};
};

LivePage::LivePage(const std::string& host, int port, LiveBoard& board) : server_(std::make_unique<Server>()), board_(board) {
  auto& http = server_->http;
  http.new_task_queue = [] { return new httplib::ThreadPool(kMostBrowsers + 8); };
  http.Get("/", [](const httplib::Request&, httplib::Response& response) {
    response.set_content(report::watch_html(), "text/html; charset=utf-8");
  });
  http.Get("/state", [this](const httplib::Request&, httplib::Response& response) {
    std::uint64_t version = 0;
    response.set_content(board_.newer_than(version, 0.0), "text/event-stream");
  });
  http.Get("/events", [this](const httplib::Request&, httplib::Response& response) {
    if (server_->browsers.fetch_add(1) >= kMostBrowsers) {
      --server_->browsers;
      response.status = 503;
      response.set_content("too many browsers are watching\n", "text/plain");
      return;
    }
    response.set_header("Cache-Control", "no-store");
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, version = std::uint64_t{0}](std::size_t, httplib::DataSink& sink) mutable {
          if (board_.closed()) {
            sink.done();
            return true;
          }
          std::string text = board_.newer_than(version, kKeepAlive);
          if (text.empty()) text = ": nothing new\n\n";
          return sink.write(text.data(), text.size());
        },
        [this](bool) { --server_->browsers; });
  });
  port_ = port == 0 ? http.bind_to_any_port(host.c_str()) : http.bind_to_port(host.c_str(), port) ? port : -1;
  if (port_ < 0) throw InputError(fmt::format("cannot listen on {}:{}; is the port taken?", host, port));
  thread_ = std::thread([this] { server_->http.listen_after_bind(); });
}

LivePage::~LivePage() {
  board_.close();
  while (!server_->http.is_running()) std::this_thread::yield();  // stop() before the start would be forgotten
  server_->http.stop();
  thread_.join();
}

}  // namespace outrider::app
