// `outrider watch`: a live team in a browser.

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "explorer/map_exchange.hpp"
#include "explorer/overheard.hpp"
#include "link/lc02.hpp"
#include "link/multicast.hpp"
#include "live.hpp"
#include "live_page.hpp"
#include "world/error.hpp"

namespace outrider::app {
namespace {

using report::Json;

constexpr double kState = 0.1, kMaps = 0.5;  // [s] between two looks at robots and at maps

struct Options {
  std::string url = "udpm://239.255.76.67:7667?ttl=0", host = "127.0.0.1";
  std::filesystem::path key_file;
  std::int32_t run = 0;
  int port = 7680;
};

/// Listens, catches up with the team's map like a robot that never speaks of itself, and keeps the board up to date.
class Watcher {
 public:
  Watcher(const Options& o, LiveBoard& board)
      : board_(board), key_(o.key_file.empty() ? std::nullopt : std::optional(link::TeamKey::read(o.key_file))), team_(o.run, key_) {
    std::string why;
    socket_ = link::MulticastSocket::open(link::MulticastUrl::parse(o.url), why);
    if (!socket_) throw InputError(fmt::format("{}: {}; as root: ip route add 224.0.0.0/4 dev lo", o.url, why));
    boot_ = std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
  }

  void run(const std::atomic<bool>& interrupted) {
    double state_s = 0.0, maps_s = 0.0;
    while (!interrupted) {
      pollfd ready{socket_->fd(), POLLIN, 0};
      poll(&ready, 1, 50);
      const double now_s = monotonic_s() - begin_s_;
      drain(now_s);
      if (exchange_)
        for (const Message& message : exchange_->speak(now_s)) ask(message);
      if (now_s >= state_s) board_.set("state", "state", state(now_s).dump()), state_s = now_s + kState;
      if (team_.introduced() && now_s >= maps_s) show_maps(), maps_s = now_s + kMaps;
    }
  }

 private:
  void drain(double now_s) {
    std::array<std::uint8_t, kMostMessageBytes + 1> buffer;
    for (int k = 0; k < 4096; ++k) {
      const auto size = socket_->receive(buffer);
      if (!size) return;
      const auto frame = link::parse_lc02({buffer.data(), *size});
      const auto* heard = std::get_if<link::Lc02>(&frame);
      if (heard == nullptr) continue;
      const auto message = team_.hear(heard->channel, heard->payload, now_s);
      if (!message) continue;
      if (!exchange_) exchange_.emplace(link::kObserver, team_.map(), explorer::MapExchange::Settings{});
      exchange_->hear(*message, now_s);
    }
  }

  /// An observer may compare and ask; what it knows the robots know better.
  void ask(const Message& message) {
    if (!std::holds_alternative<MapDigest>(message) && !std::holds_alternative<TileRequest>(message)) return;
    auto payload = link::encode({0, boot_, ++sequence_, team_.run(), link::kObserver}, message);
    if (key_) key_->sign(payload);
    socket_->send(link::make_lc02(static_cast<std::uint32_t>(sequence_), link::channel_of(message), payload));
  }

  Json point(Cell c) const {
    const Point p = team_.introduction().geometry.center(c);
    return {p.x, p.y};
  }

  std::string name(RobotId id) const {
    const auto robot = team_.robots().find(id);
    const bool known = robot != team_.robots().end() && !robot->second.spec.name.empty();
    return known ? robot->second.spec.name : fmt::format("robot {}", id + 1);
  }

  Json state(double now_s) const {
    if (!team_.introduced()) return {{"t", now_s}};
    const Introduction& intro = team_.introduction();
    const GridGeometry& g = intro.geometry;
    Json names = Json::array(), robots = Json::array();
    for (RobotId id = 0; id < intro.team; ++id) {
      const auto robot = team_.robots().find(id);
      const bool known = robot != team_.robots().end();
      const RobotSpec spec = known ? robot->second.spec : RobotSpec{};
      names.push_back({{"name", name(id)}, {"range", spec.range}, {"radius", spec.radius}});
      robots.push_back(known ? robot_state(robot->second, now_s) : Json{{"age_s", nullptr}, {"hears", Json::array()}});
    }
    const auto& cells = team_.map().states().data();
    const auto unknown = std::count(cells.begin(), cells.end(), CellState::kUnknown);
    return {{"t", now_s},
            {"known", 1.0 - static_cast<double>(unknown) / static_cast<double>(cells.size())},
            {"team", {{"run", team_.run()}, {"coordinator", intro.coordinator}, {"robots", names},
                      {"map", {{"width", g.width}, {"height", g.height}, {"resolution", g.resolution},
                               {"origin", {g.origin.x, g.origin.y}}}}}},
            {"robots", robots}, {"auctions", auctions()}, {"air", air()}};
  }

  Json robot_state(const explorer::OverheardRobot& robot, double now_s) const {
    Json state{{"age_s", now_s - robot.heard_s}, {"hears", Json::array()}};
    if (!robot.status) return state;
    const StatusMessage& s = *robot.status;
    state["pose"] = {s.pose.x, s.pose.y, s.pose.theta};
    state["done"] = s.done;
    state["hears"] = s.heard;
    if (s.goal) state["goal"] = point(*s.goal);
    state["way"] = Json::array();
    for (const Cell c : s.way) state["way"].push_back(point(c));
    return state;
  }

  Json auctions() const {
    Json list = Json::array();
    const auto& all = team_.auctions();
    for (auto a = all.rbegin(); a != all.rend() && list.size() < 8; ++a) {
      Json bids = Json::array(), awards = Json::array();
      for (const BidSheet& sheet : a->sheets) bids.push_back({{"robot", name(sheet.robot)}, {"tasks", sheet.entries.size()}});
      for (const Award& award : a->awards)
        awards.push_back({{"robot", name(award.robot)}, {"task", point(award.task)}, {"value", award.value}});
      list.push_back({{"t", a->t}, {"seller", name(a->round.opener)}, {"bids", bids}, {"awards", awards}});
    }
    return list;
  }

  Json air() const {
    Json list{{"messages", team_.heard()}, {"bytes", team_.bytes()}};
    for (std::size_t k = 0; k < link::kRejections; ++k)
      if (team_.rejections().count[k] > 0) list[std::string("rejected: ") + std::string(link::kRejectionNames[k])] = team_.rejections().count[k];
    return list;
  }

  void show_maps() {
    show_map("the team", team_.map());
    for (const auto& [id, robot] : team_.robots()) {
      const bool caught_up = robot.status && robot.status->map_hash == team_.map().hash();
      if (robot.said) show_map(name(id), caught_up ? team_.map() : *robot.said);
    }
  }

  void show_map(const std::string& whose, const TeamMap& map) {
    const auto [shown, first] = shown_.try_emplace(whose, 0);
    if (!first && shown->second == map.hash()) return;
    shown->second = map.hash();
    const auto& cells = map.states().data();
    Json runs = Json::array();
    for (std::size_t k = 0, end = 0; k < cells.size(); k = end) {
      for (end = k + 1; end < cells.size() && cells[end] == cells[k];) ++end;
      runs.push_back(static_cast<int>(cells[k]));
      runs.push_back(end - k);
    }
    board_.set("map " + whose, "map", Json{{"name", whose}, {"runs", std::move(runs)}}.dump());
  }

  LiveBoard& board_;
  std::optional<link::TeamKey> key_;
  explorer::Overheard team_;
  std::optional<explorer::MapExchange> exchange_;
  std::optional<link::MulticastSocket> socket_;
  std::map<std::string, std::uint64_t> shown_;  // hash of each map as last sent
  double begin_s_ = monotonic_s();
  std::int64_t boot_ = 0, sequence_ = 0;
};

void watch(const Options& o, Context& ctx) {
  LiveBoard board;
  Watcher watcher(o, board);
  const LivePage page(o.host, o.port, board);
  if (!ctx.quiet) {
    fmt::print("watching; the page is at http://{}:{}/ (Ctrl-C ends)\n", o.host, page.port());
    std::fflush(stdout);
  }
  watcher.run(*ctx.interrupted);
  ctx.exit_code = kInterrupted;
}

}  // namespace

void add_watch(CLI::App& app, Context& ctx) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("watch", "a live team in a browser");
  verb->add_option("--url", o->url, "multicast group of the team")->capture_default_str()->type_name("URL");
  verb->add_option("--key", o->key_file, "file with the team's secret")->type_name("FILE");
  verb->add_option("--run", o->run, "number of the team (default: the first that is heard)")
      ->check(CLI::Range(0, 2147483647))->type_name("N");
  verb->add_option("--host", o->host, "address to serve the page on")->capture_default_str()->type_name("ADDRESS");
  verb->add_option("--port", o->port, "port to serve the page on; 0: any free one")->check(CLI::Range(0, 65535))
      ->capture_default_str()->type_name("PORT");
  verb->add_flag("-q,--quiet", ctx.quiet, "do not print the address");
  verb->callback([o, &ctx] { watch(*o, ctx); });
}

}  // namespace outrider::app
