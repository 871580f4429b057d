#include "explorer/journal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>

#include "explorer/referee.hpp"

namespace outrider::explorer {
namespace {

/// Words of a line as numbers; remembers whether all were.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  template <class T>
  T next() {
    T value{};
    skip_blanks();
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    good_ = good_ && error == std::errc();
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value;
  }
  /// The next character, when it is `c`.
  bool take(char c) {
    if (rest_.empty() || rest_.front() != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  bool more() {
    skip_blanks();
    return good_ && !rest_.empty();
  }
  bool good() const { return good_; }

 private:
  void skip_blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size())); }
  std::string_view rest_;
  bool good_ = true;
};

std::optional<RobotJournal::Entry> read_entry(Words words, std::size_t cells) {
  RobotJournal::Entry entry;
  entry.t = words.next<double>();
  entry.pose = {words.next<double>(), words.next<double>(), words.next<double>()};
  while (words.more()) {
    const auto first = words.next<std::uint32_t>();
    const auto length = words.take('+') ? words.next<std::uint32_t>() : 1;
    if (!words.good() || first >= cells || length > cells - first) return std::nullopt;
    for (std::uint32_t k = 0; k < length; ++k) entry.cells.push_back(first + k);
  }
  return words.good() ? std::optional(std::move(entry)) : std::nullopt;
}

std::optional<LiveFarewell> read_farewell(Words words, const GridGeometry& geometry) {
  LiveFarewell f;
  f.end = static_cast<LiveEnd>(std::clamp(words.next<int>(), 0, 2));
  f.t = words.next<double>();
  f.done_s = words.next<double>();
  f.path_m = words.next<double>();
  f.equal_s = words.next<double>();
  f.map_hash = words.next<std::uint64_t>();
  for (std::uint64_t* n : {&f.bus.sent, &f.bus.bytes, &f.bus.unsent, &f.bus.delivered, &f.bus.reopened})
    *n = words.next<std::uint64_t>();
  for (std::uint64_t& n : f.rejections.count) n = words.next<std::uint64_t>();
  f.map = OccupancyGrid(geometry);
  for (std::size_t i = 0; words.more();) {
    const auto state = words.next<unsigned>();
    const auto length = words.take('*') ? words.next<std::size_t>() : 1;
    if (state > 2 || length > f.map.size() - i) return std::nullopt;
    std::fill_n(f.map.data().begin() + static_cast<std::ptrdiff_t>(i), length, static_cast<CellState>(state));
    i += length;
  }
  return words.good() ? std::optional(std::move(f)) : std::nullopt;
}

/// A frontier that anybody tried in vain is not observable, whatever the first robot thinks of it.
void merge_left(const std::vector<Left>& other, std::vector<Left>& left) {
  if (left.empty()) left = other;
  for (std::size_t k = 0; k < std::min(other.size(), left.size()); ++k)
    if (other[k].why == LeftReason::kNotObservable) left[k].why = other[k].why;
}

MissionStatus status_of(const std::vector<RobotJournal>& journals, double explored_fraction) {
  const auto ended = [&](LiveEnd end) {
    return std::any_of(journals.begin(), journals.end(), [&](const auto& j) { return j.farewell && j.farewell->end == end; });
  };
  if (ended(LiveEnd::kInterrupted)) return MissionStatus::kInterrupted;
  if (ended(LiveEnd::kTimeout)) return MissionStatus::kTimeout;
  if (!ended(LiveEnd::kTeamDone)) return MissionStatus::kFailed;
  return explored_fraction >= Referee::kExplored ? MissionStatus::kExplored : MissionStatus::kUnreachableLeft;
}

}  // namespace

std::string entry_line(double t, const Pose2& pose, const std::vector<std::uint32_t>& cells) {
  std::string line = fmt::format("P {:.3f} {:.6f} {:.6f} {:.6f}", t, pose.x, pose.y, pose.theta);
  std::vector<std::uint32_t> sorted = cells;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t k = 0, end = 0; k < sorted.size(); k = end) {
    for (end = k + 1; end < sorted.size() && sorted[end] == sorted[end - 1] + 1;) ++end;
    fmt::format_to(std::back_inserter(line), " {}+{}", sorted[k], end - k);
  }
  return line;
}

void write_farewell(const LiveFarewell& f, const LineSink& sink) {
  for (const Left& left : f.left)
    sink(fmt::format("L {:.6f} {:.6f} {:.6f} {}", left.frontier.x, left.frontier.y, left.unknown_m2, static_cast<int>(left.why)));
  std::string line = fmt::format("F {} {:.3f} {:.3f} {:.6f} {:.3f} {} {} {} {} {} {}", static_cast<int>(f.end), f.t, f.done_s,
                                 f.path_m, f.equal_s, f.map_hash, f.bus.sent, f.bus.bytes, f.bus.unsent, f.bus.delivered,
                                 f.bus.reopened);
  for (const std::uint64_t n : f.rejections.count) fmt::format_to(std::back_inserter(line), " {}", n);
  for (std::size_t k = 0, end = 0; k < f.map.size(); k = end) {
    for (end = k + 1; end < f.map.size() && f.map[end] == f.map[k];) ++end;
    fmt::format_to(std::back_inserter(line), " {}*{}", static_cast<int>(f.map[k]), end - k);
  }
  sink(line);
}

void read_line(std::string_view line, const GridGeometry& geometry, RobotJournal& journal) {
  if (line.size() < 3 || line[1] != ' ') return;
  const std::string_view rest = line.substr(2);
  switch (line[0]) {
    case 'P':
      if (auto entry = read_entry(Words(rest), geometry.size())) journal.entries.push_back(std::move(*entry));
      break;
    case 'E': journal.events.emplace_back(rest); break;
    case 'L': {
      Words words(rest);
      const Point at{words.next<double>(), words.next<double>()};
      const auto m2 = words.next<double>();
      const Left left{at, m2, static_cast<LeftReason>(std::clamp(words.next<int>(), 0, 2))};
      if (!journal.farewell) journal.farewell.emplace();
      if (words.good()) journal.farewell->left.push_back(left);
      break;
    }
    case 'F': {
      auto farewell = read_farewell(Words(rest), geometry);
      if (farewell && journal.farewell) farewell->left = std::move(journal.farewell->left);
      if (farewell) journal.farewell = std::move(farewell);
      break;
    }
    default: break;
  }
}

MissionResult gather(const OccupancyGrid& truth, const std::vector<RobotSpec>& team,
                     const std::vector<RobotJournal>& journals) {
  struct Moment {
    double t;
    std::size_t robot;
    const RobotJournal::Entry* entry;
  };
  std::vector<Moment> moments;
  for (std::size_t r = 0; r < journals.size(); ++r)
    for (const auto& entry : journals[r].entries) moments.push_back({entry.t, r, &entry});
  std::stable_sort(moments.begin(), moments.end(), [](const Moment& a, const Moment& b) { return a.t < b.t; });
  Referee referee(truth, team);
  MissionResult result;
  for (const auto& [t, r, entry] : moments) {
    referee.saw(static_cast<RobotId>(r), entry->cells, t);
    referee.stands(static_cast<RobotId>(r), {t, entry->pose});
    referee.tick(t);
    result.mission_time_s = t;
  }
  std::vector<const OccupancyGrid*> maps;
  result.maps_equal = true;
  const LiveFarewell* first = nullptr;
  for (std::size_t r = 0; r < team.size(); ++r) {
    result.robots.push_back(referee.robot(static_cast<RobotId>(r)));
    const auto& farewell = journals[r].farewell;
    if (!farewell || farewell->map.size() == 0) continue;
    MissionRobot& robot = result.robots.back();
    robot.map = farewell->map;
    robot.path_m = farewell->path_m;
    maps.push_back(&farewell->map);
    if (first == nullptr) first = &*farewell;
    result.maps_equal = result.maps_equal && farewell->map_hash == first->map_hash && farewell->map == first->map;
    result.time_s = std::max(result.time_s, farewell->done_s);
    result.radio.sent += farewell->bus.sent;
    result.radio.delivered += farewell->bus.delivered;
    result.radio.bytes += farewell->bus.bytes;
    merge_left(farewell->left, result.left);
  }
  for (MissionRobot& robot : result.robots)
    if (robot.map.size() == 0) robot.map = OccupancyGrid(truth.geometry());
  referee.conclude(maps, result);
  result.status = status_of(journals, result.explored_fraction);
  return result;
}

}  // namespace outrider::explorer
