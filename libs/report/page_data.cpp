#include "report/page_data.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "report/metrics.hpp"

namespace outrider::report {
namespace {

constexpr std::size_t kMaxPoints = 60'000;
constexpr std::size_t kMinPointsPerRobot = 200;
constexpr std::size_t kMaxRows = 1'000;
constexpr std::size_t kMaxEvents = 20'000;
constexpr std::size_t kMaxEventBytes = 16'000'000;  // before compression

/// To so many parts of one; dividing last leaves the shortest decimal.
double rounded(double value, double parts) { return std::round(value * parts) / parts; }
std::int64_t hundredths(double value) { return std::llround(value * 100.0); }

/// Indices 0, k, 2k, ... and the last one; at most about `most`.
std::vector<std::size_t> thinned(std::size_t size, std::size_t most) {
  std::vector<std::size_t> indices;
  const std::size_t stride = std::max<std::size_t>(1, (size + most - 1) / most);
  for (std::size_t i = 0; i < size; i += stride) indices.push_back(i);
  if (size > 0 && indices.back() != size - 1) indices.push_back(size - 1);
  return indices;
}

double time_zero(const RunRecord& record) {
  double first = std::numeric_limits<double>::infinity();
  for (const RobotRecord& robot : record.robots)
    if (!robot.trajectory.empty()) first = std::min(first, robot.trajectory.front().t - robot.clock_s);
  return std::isfinite(first) ? first : 0.0;
}

/// Trajectory as integers: hundredths of a second and centimetres.
Json path_json(const std::vector<TimedPose>& trajectory, double t0, std::size_t most) {
  Json t = Json::array(), x = Json::array(), y = Json::array();
  for (const std::size_t i : thinned(trajectory.size(), most)) {
    t.push_back(hundredths(trajectory[i].t - t0));
    x.push_back(hundredths(trajectory[i].pose.x));
    y.push_back(hundredths(trajectory[i].pose.y));
  }
  return {{"t", std::move(t)}, {"x", std::move(x)}, {"y", std::move(y)}};
}

Json robots_json(const RunRecord& record) {
  const double t0 = time_zero(record);
  const std::size_t most = std::max(kMinPointsPerRobot, kMaxPoints / std::max<std::size_t>(1, record.robots.size()));
  Json robots = Json::array();
  for (const RobotRecord& robot : record.robots)
    robots.push_back({{"name", robot.spec.name},
                      {"range", rounded(robot.spec.range, 100.0)},
                      {"radius", rounded(robot.spec.radius, 100.0)},
                      {"path", path_json(robot.in_team_frame ? robot.trajectory : std::vector<TimedPose>(),
                                         t0 + robot.clock_s, most)}});
  return robots;
}

Json timeline_json(const RunRecord& record) {
  const double t0 = time_zero(record);
  Json t = Json::array(), team = Json::array(), area = Json::array(), robots = Json::array();
  for (std::size_t i = 0; i < record.robots.size(); ++i) robots.push_back(Json::array());
  for (const std::size_t i : thinned(record.timeline.size(), kMaxRows)) {
    const TimelineRow& row = record.timeline[i];
    t.push_back(rounded(row.time_s >= t0 ? row.time_s - t0 : row.time_s, 100.0));
    team.push_back(rounded(row.explored_fraction, 1e5));
    area.push_back(rounded(row.explored_m2, 100.0));
    for (std::size_t r = 0; r < robots.size() && r < row.robot_m2.size(); ++r)
      robots[r].push_back(rounded(row.robot_m2[r], 100.0));
  }
  return {{"t", std::move(t)}, {"fraction", std::move(team)}, {"m2", std::move(area)}, {"robots", std::move(robots)}};
}

template <class T>
std::string layer(const std::vector<T>& cells) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(cells.size() * sizeof(T));
  for (const T cell : cells) {
    const auto value = static_cast<std::uint16_t>(cell);
    bytes.push_back(static_cast<std::uint8_t>(value & 0xFFU));
    if constexpr (sizeof(T) == 2) bytes.push_back(static_cast<std::uint8_t>(value >> 8U));
  }
  return packed(bytes);
}

Json map_json(const RunRecord& record) {
  const GridGeometry& g = record.map.geometry();
  Json map{{"width", g.width},
           {"height", g.height},
           {"resolution", g.resolution},
           {"origin", {g.origin.x, g.origin.y}},
           {"step_s", record.playback_step_s},
           {"state", layer(record.map.data())}};
  if (record.known_since.geometry() == g) map["known_since"] = layer(record.known_since.data());
  const auto counts = seen_counts(record.robots);
  if (counts && counts->geometry() == g && record.robots.size() > 1) map["seen"] = layer(counts->data());
  if (record.truth) {
    map["errors"] = layer(map_errors(record.map, *record.truth, record.T_truth_map).data());
    map["truth"] = layer(resampled(*record.truth, g, inverse(record.T_truth_map)).data());
  }
  return map;
}

Json events_json(const RunRecord& record) {
  std::string lines;
  std::size_t shown = 0;
  for (; shown < std::min(record.events.size(), kMaxEvents) && lines.size() < kMaxEventBytes; ++shown) {
    if (shown > 0) lines += '\n';
    lines += to_text(record.events[shown]);
  }
  return {{"total", record.events.size()},
          {"shown", shown},
          {"packed", packed({reinterpret_cast<const std::uint8_t*>(lines.data()), lines.size()})}};
}

/// A(k) of every robot as it was when it bid (Dai 2014, eq. 8): {name: {"t", "a"}} [s], [m^2/s].
Json rates_json(const RunRecord& record) {
  std::map<std::string, std::vector<std::pair<double, double>>> rates;
  for (const Json& event : record.events) {
    if (event.value("event", std::string()) != "auction" || !event.contains("bids")) continue;
    for (const Json& bid : event["bids"])
      if (bid.contains("explored_rate_m2_s")) rates[bid["robot"]].emplace_back(event["t"].get<double>(), bid["explored_rate_m2_s"].get<double>());
  }
  Json json = Json::object();
  for (const RobotRecord& robot : record.robots) {
    const auto& own = rates[robot.spec.name];
    Json t = Json::array(), a = Json::array();
    for (const std::size_t i : thinned(own.size(), kMaxRows)) {
      t.push_back(rounded(own[i].first, 100.0));
      a.push_back(rounded(own[i].second, 1000.0));
    }
    if (!t.empty()) json[robot.spec.name] = {{"t", std::move(t)}, {"a", std::move(a)}};
  }
  return json;
}

}  // namespace

std::string base64(std::span<const std::uint8_t> bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = (word << 8U) | (k < n ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= n ? kDigits[(word >> (18U - 6U * k)) & 63U] : '=';
  }
  return text;
}

std::string packed(std::span<const std::uint8_t> bytes) {
  z_stream stream{};
  constexpr int kGzip = 15 + 16;
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::runtime_error("zlib: no memory");
  std::vector<std::uint8_t> out(deflateBound(&stream, static_cast<uLong>(bytes.size())));
  stream.next_in = const_cast<Bytef*>(bytes.data());  // zlib reads only
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  const int status = deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (status != Z_STREAM_END) throw std::runtime_error("zlib: deflate failed");
  return base64(out);
}

Json page_data(const RunRecord& record, const Json& result) {
  Json data{{"t0", time_zero(record)},
            {"robots", robots_json(record)},
            {"timeline", timeline_json(record)},
            {"events", events_json(record)}};
  if (Json rates = rates_json(record); !rates.empty()) data["rates"] = std::move(rates);
  if (record.map.size() > 0) data["map"] = map_json(record);
  for (const char* key : {"path_m", "share", "overlap", "left"})
    if (result.contains(key)) data[key] = result[key];
  return data;
}

}  // namespace outrider::report
