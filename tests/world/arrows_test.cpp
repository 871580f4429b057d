// The floor plan, checked from the sources: which room may include which, and which library lives where.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace outrider {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

/// Rooms that a room may include, besides itself: everything on the floors below, nothing beside it.
const std::map<std::string, Names>& arrows() {
  static const Names kMiddle{"slam_glue", "decision", "auction", "link", "sim"};
  static const std::map<std::string, Names> kArrows = [] {
    std::map<std::string, Names> table{{"world", {}}};
    for (const std::string& room : kMiddle) table[room] = {"world"};
    Names below = kMiddle;
    below.insert("world");
    table["explorer"] = table["report"] = below;
    below.insert({"explorer", "report"});
    table["apps"] = below;
    return table;
  }();
  return kArrows;
}

/// Who may include headers of a third party. `headers_too`: also in a header of ours.
struct Lodger {
  std::string prefix;
  Names rooms;
  bool headers_too = true;
};
const std::vector<Lodger> kLodgers{{"mrpt/", {"slam_glue"}, false},
                                   {"octomap/", {"slam_glue"}, false},
                                   {"lcm/", {"link"}},
                                   {"lcm-cpp", {"link"}},
                                   {"outrider_wire/", {"link"}},
                                   {"bot_core/", {"link"}},
                                   {"sodium", {"link"}, false},
                                   {"httplib", {"apps"}},
                                   {"CLI/", {"apps"}},
                                   {"opencv2/", {"slam_glue", "decision", "report", "apps"}, false},
                                   {"nlohmann/", {"report", "explorer", "apps"}},
                                   {"thread", {"slam_glue", "link", "sim", "explorer", "report", "apps"}},
                                   {"chrono", {"slam_glue", "link", "sim", "explorer", "report", "apps"}}};

struct Source {
  fs::path path;
  std::string room;
  std::vector<std::string> includes, lines;
  bool is_header() const { return path.extension() == ".hpp"; }
};

std::vector<Source> sources() {
  std::vector<Source> found;
  const std::regex include(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  for (const std::string top : {"libs", "apps"}) {
    const fs::path root = fs::path(OUTRIDER_SOURCE_DIR) / top;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
      const fs::path path = entry.path();
      if (path.extension() != ".hpp" && path.extension() != ".cpp") continue;
      Source source{path, top == "apps" ? "apps" : fs::relative(path, root).begin()->string(), {}, {}};
      std::ifstream file(path);
      std::smatch match;
      for (std::string line; std::getline(file, line);) {
        if (std::regex_search(line, match, include)) source.includes.push_back(match[1]);
        source.lines.push_back(line);
      }
      found.push_back(std::move(source));
    }
  }
  std::sort(found.begin(), found.end(), [](const Source& a, const Source& b) { return a.path < b.path; });
  return found;
}

TEST(Arrows, RoomsIncludeOnlyWhatLiesBelow) {
  const auto all = sources();
  ASSERT_GT(all.size(), 10U);
  for (const Source& source : all) {
    ASSERT_TRUE(arrows().contains(source.room)) << source.path << ": a room that the plan does not know";
    for (const std::string& include : source.includes) {
      const std::string to = include.substr(0, include.find('/'));
      if (to == include || to == source.room || !arrows().contains(to)) continue;
      EXPECT_TRUE(arrows().at(source.room).contains(to)) << source.path << " includes " << include;
    }
  }
}

TEST(Arrows, LibrariesStayInTheirRooms) {
  for (const Source& source : sources())
    for (const std::string& include : source.includes)
      for (const Lodger& lodger : kLodgers) {
        if (!include.starts_with(lodger.prefix)) continue;
        EXPECT_TRUE(lodger.rooms.contains(source.room)) << source.path << " includes " << include;
        EXPECT_TRUE(lodger.headers_too || !source.is_header()) << source.path << ": " << include << " in a header";
      }
}

TEST(Arrows, ThinkingRoomsSeeNoRandomDeviceAndNoClock) {
  const std::regex forbidden(R"(\b(random_device|std::rand|srand|system_clock|steady_clock|clock_gettime|getenv)\b)");
  for (const Source& source : sources()) {
    if (source.room != "world" && source.room != "decision" && source.room != "auction") continue;
    for (const std::string& line : source.lines)
      EXPECT_FALSE(std::regex_search(line, forbidden)) << source.path << ": " << line;
  }
}

}  // namespace
}  // namespace outrider
