#pragma once
// The web server of `outrider watch`: one page, and Server-Sent Events for it.

#include <atomic>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace outrider::app {

/// The newest of everything that a browser shows. A slow browser misses what is old, nobody waits for it. Thread-safe.
class LiveBoard {
 public:
  struct Item {
    std::uint64_t version = 0;
    std::string event;  ///< ready for the wire: "event: ...\ndata: ...\n\n"
  };
  void set(const std::string& name, const std::string& event, const std::string& data);
  /// What is newer than `version`, "state" first, once there is something or after `timeout_s`; moves `version` on.
  std::string newer_than(std::uint64_t& version, double timeout_s) const;
  void close();
  bool closed() const { return closed_; }

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable news_;
  std::map<std::string, Item> items_;
  std::uint64_t version_ = 0;
  std::atomic<bool> closed_{false};
};

/// Serves "/", "/events" and "/state" until destroyed.
class LivePage {
 public:
  /// Throws InputError when the address is taken or is none. Port 0: any free one.
  LivePage(const std::string& host, int port, LiveBoard& board);
  ~LivePage();
  int port() const { return port_; }

 private:
  struct Server;
  std::unique_ptr<Server> server_;
  LiveBoard& board_;
  int port_ = 0;
  std::thread thread_;
};

}  // namespace outrider::app
