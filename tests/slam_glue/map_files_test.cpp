// Maps in files: what is written comes back, each format says what it should, bad files are refused by name.

#include "slam_glue/map_files.hpp"

#include "slam_glue/files.hpp"
#include "support/ascii.hpp"

namespace outrider::slam_glue {
namespace {

using test::input_error;
using test::TempDir;
using test::to_ascii;

OccupancyGrid small_map() {
  const OccupancyGrid drawn = test::grid_from_ascii("##?\n..#\n?..\n...");
  OccupancyGrid map(GridGeometry{0.05, {-1.25, 3.5}, drawn.width(), drawn.height()});
  map.data() = drawn.data();
  return map;
}

std::string load_error(const std::filesystem::path& file, const MapLoadOptions& options = {}) {
  return input_error([&] { load_map(file, options); });
}

TEST(MapFiles, RosAndGridmapsComeBack) {
  const TempDir dir;
  const OccupancyGrid map = small_map();
  save_ros_map(map, dir / "m.yaml");
  save_gridmap(map, dir / "m.gridmap");
  save_gridmap(map, dir / "m.gridmap.gz");
  for (const char* name : {"m.yaml", "m.gridmap", "m.gridmap.gz"}) {
    SCOPED_TRACE(name);
    const OccupancyGrid back = load_map(dir / name).grid;
    EXPECT_EQ(to_ascii(back), to_ascii(map));
    EXPECT_NEAR(back.geometry().resolution, 0.05, 1e-9);
    EXPECT_NEAR(back.geometry().origin.x, -1.25, 1e-6);
    EXPECT_NEAR(back.geometry().origin.y, 3.5, 1e-6);
  }
  const std::string pgm = test::bytes_of(dir / "m.pgm");
  EXPECT_EQ(pgm.substr(pgm.size() - 12), std::string("\x00\x00\xCD\xFE\xFE\x00\xCD\xFE\xFE\xFE\xFE\xFE", 12));
}

TEST(MapFiles, OctomapIsWritten) {
  const TempDir dir;
  save_octomap(small_map(), dir / "m.bt", 0.3);
  EXPECT_EQ(test::bytes_of(dir / "m.bt").substr(0, 27), "# Octomap OcTree binary fil");
}

TEST(MapFiles, WritersSayWhenTheyCannot) {
  const TempDir dir;
  EXPECT_THROW(save_ros_map(small_map(), dir / "no/m.yaml"), std::runtime_error);
  EXPECT_THROW(save_gridmap(small_map(), dir / "no/m.gridmap"), std::runtime_error);
  EXPECT_THROW(save_octomap(small_map(), dir / "no/m.bt", 0.0), std::runtime_error);
  if (!std::filesystem::exists("/dev/full")) return;
  EXPECT_THROW(save_octomap(small_map(), "/dev/full", 0.0), std::runtime_error);
}

TEST(MapFiles, RosThresholdsNegateAndOrigin) {
  const TempDir dir;
  dir.write("m.pgm", "P5\n4 1\n255\n" + std::string("\x00\xCD\xFE\x60", 4));
  const auto yaml = [&](const std::string& more) {
    return dir.write("m.yaml", "image: m.pgm\nresolution: 0.1\norigin: [1, 2, 0]\n" + more);
  };
  EXPECT_EQ(to_ascii(load_map(yaml("negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n")).grid), "#?.?\n");
  EXPECT_EQ(to_ascii(load_map(yaml("negate: 0\noccupied_thresh: 0.5\nfree_thresh: 0.25\n")).grid), "#..#\n");
  EXPECT_EQ(to_ascii(load_map(yaml("negate: 1\noccupied_thresh: 0.65\nfree_thresh: 0.196\n")).grid), ".##?\n");
  EXPECT_NE(load_error(yaml("mode: other\n")).find("mode"), std::string::npos);
  const auto turned = dir.write("t.yaml", "image: m.pgm\nresolution: 0.1\norigin: [1, 2, 0.5]\n");
  EXPECT_NE(load_error(turned).find("yaw"), std::string::npos);
  EXPECT_NE(load_error(dir.write("r.yaml", "image: m.pgm\norigin: [0, 0, 0]\n")).find("resolution"), std::string::npos);
  EXPECT_NE(load_error(dir.write("i.yaml", "image: x.pgm\nresolution: 1\norigin: [0, 0, 0]\n")).find("x.pgm"),
            std::string::npos);
  EXPECT_NE(load_error(dir.write("n.yaml", "just words\n")).find("n.yaml"), std::string::npos);
}

TEST(MapFiles, PlainImagesAreBrightOrDark) {
  const TempDir dir;
  const auto file = dir.write("m.pgm", "P5\n4 2\n255\n" + std::string("\x00\x7F\x80\xFF\xFF\xFF\xFF\x00", 8));
  const OccupancyGrid map = load_map(file, {0.5}).grid;
  EXPECT_EQ(to_ascii(map), "##..\n...#\n");
  EXPECT_DOUBLE_EQ(map.geometry().resolution, 0.5);
  EXPECT_NE(load_error(file).find("--resolution"), std::string::npos);
  EXPECT_NE(load_error(dir.write("no.png", "no image"), {0.5}).find("no.png"), std::string::npos);
  EXPECT_NE(load_error(file, {-1.0}).find("resolution"), std::string::npos);
}

TEST(MapFiles, MovingAi) {
  const TempDir dir;
  const std::string head = "type octile\nheight 2\nwidth 4\nmap\n";
  const auto map = load_map(dir.write("m.map", head + ".GS@\r\nOTW.\n")).grid;
  EXPECT_EQ(to_ascii(map), "...#\n###.\n");
  EXPECT_DOUBLE_EQ(map.geometry().resolution, 1.0);
  EXPECT_NE(load_error(dir.write("a.map", head + "....\n")).find("height"), std::string::npos);
  EXPECT_NE(load_error(dir.write("b.map", head + "....\n...\n")).find("b.map:6"), std::string::npos);
  EXPECT_NE(load_error(dir.write("c.map", head + "..x.\n....\n")).find("c.map:5"), std::string::npos);
  EXPECT_NE(load_error(dir.write("d.map", "type octile\nheight 99999999999\nwidth 4\nmap\n")).find("d.map:2"),
            std::string::npos);
}

TEST(MapFiles, Ascii) {
  const TempDir dir;
  const LoadedMap loaded = load_map(dir.write("m.txt", "#2.\n? 1\n##\n"), {2.0});
  EXPECT_EQ(to_ascii(loaded.grid), "#..\n?..\n##?\n");
  ASSERT_EQ(loaded.starts.size(), 2u);
  EXPECT_EQ(loaded.starts[0], (Point{5.0, 3.0}));
  EXPECT_EQ(loaded.starts[1], (Point{3.0, 5.0}));
  EXPECT_NE(load_error(dir.write("x.txt", "...\n.x.\n")).find("x.txt:2: column 2"), std::string::npos);
  EXPECT_NE(load_error(dir.write("t.txt", "1.1\n")).find("twice"), std::string::npos);
  EXPECT_NE(load_error(dir.write("e.txt", "\n\n")).find("empty"), std::string::npos);
}

TEST(MapFiles, DamagedGridmapsAndUnknownFilesAreRefused) {
  const TempDir dir;
  save_gridmap(small_map(), dir / "m.gridmap.gz");
  save_gridmap(small_map(), dir / "m.gridmap");
  for (const char* name : {"m.gridmap", "m.gridmap.gz"}) {
    const std::string bytes = test::bytes_of(dir / name);
    const auto cut = dir.write(std::string("cut.") + name, bytes.substr(0, bytes.size() / 2));
    EXPECT_NE(load_error(cut).find("cut.m.gridmap"), std::string::npos);
  }
  EXPECT_NE(load_error(dir.write("g.gridmap", "garbage")).find("g.gridmap"), std::string::npos);
  EXPECT_NE(load_error(dir / "none.yaml").find("no such file"), std::string::npos);
  EXPECT_NE(load_error(dir.write("m.doc", "x")).find("unknown map format"), std::string::npos);
}

}  // namespace
}  // namespace outrider::slam_glue
