#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <sstream>

#include "report/run_folder.hpp"
#include "world/error.hpp"

namespace outrider::report {
namespace {

namespace fs = std::filesystem;

Json read_run_json(const fs::path& path) {
  std::ifstream file(path);
  if (!file) throw InputError(fmt::format("{}: cannot be read; expected a run folder with a run.json", path.string()));
  Json run;
  try {
    run = Json::parse(file);
  } catch (const Json::exception& e) {
    throw InputError(fmt::format("{}: not valid JSON: {}", path.string(), e.what()));
  }
  const auto require = [&](bool holds, const char* key, const char* expected) {
    if (!holds) throw InputError(fmt::format("{}: key '{}': expected {}", path.string(), key, expected));
  };
  require(run.is_object() && run.contains("schema") && run["schema"] == 1, "schema", "1");
  require(run.contains("result") && run["result"].is_object(), "result", "an object");
  require(run.contains("team") && run["team"].is_array(), "team", "a list of robots");
  for (const char* key : {"coordinator", "comms", "verb"})
    require(!run.contains(key) || run[key].is_string(), key, "a text");
  require(!run.contains("command") || run["command"].is_array(), "command", "a list of words");
  return run;
}

double number(std::string_view text, const fs::path& path, std::size_t line) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw InputError(fmt::format("{}:{}: expected a number, found '{}'", path.string(), line, text));
  return value;
}

std::vector<TimelineRow> read_timeline(const fs::path& path) {
  std::ifstream file(path);
  std::vector<TimelineRow> rows;
  std::string line;
  for (std::size_t n = 1; std::getline(file, line); ++n) {
    if (n == 1) {
      if (!line.starts_with("time_s,explored_fraction,explored_m2"))
        throw InputError(fmt::format("{}:1: expected the columns time_s,explored_fraction,explored_m2", path.string()));
      continue;
    }
    std::vector<double> values;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) values.push_back(number(cell, path, n));
    if (values.size() < 3) throw InputError(fmt::format("{}:{}: expected at least three columns", path.string(), n));
    rows.push_back({values[0], values[1], values[2], {values.begin() + 3, values.end()}});
  }
  return rows;
}

}  // namespace

RunSummary load_run(const fs::path& dir) {
  if (!fs::is_directory(dir))
    throw InputError(fmt::format("{}: {}; expected a run folder", dir.string(),
                                 fs::exists(dir) ? "not a directory" : "does not exist"));
  const fs::path normal = fs::absolute(dir).lexically_normal();
  RunSummary run{dir, (normal.has_filename() ? normal : normal.parent_path()).filename().string(), {}, {}};
  run.run = read_run_json(dir / "run.json");
  run.timeline = read_timeline(dir / "timeline.csv");
  return run;
}

}  // namespace outrider::report
