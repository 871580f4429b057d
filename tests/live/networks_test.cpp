// Robots on hosts of their own: what happens to real interfaces. See networks.sh.

#include <gtest/gtest.h>

#include <cstdlib>

#include "live/rooms.hpp"

namespace outrider::test {
namespace {

class Networks : public SystemTest, public testing::WithParamInterface<const char*> {};

TEST_P(Networks, HealAndEndWithOneMap) {
  if (std::system("unshare -Urnm sh -c 'mount -t tmpfs tmpfs /run && mkdir -p /run/netns && ip netns add x && "
                  "ip link add e0 netns x type veth peer name p0' >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "no unprivileged network namespaces, or no ip (iproute2)";
  write_rooms_and_team(dir);
  const std::string command = std::string("exec timeout 60 unshare -Urnm bash ") + OUTRIDER_SOURCE_DIR + "/tests/live/networks.sh " +
                              OUTRIDER_BINARY + " " + dir.string() + " 8 " + GetParam();
  EXPECT_EQ(std::system(command.c_str()), 0);
  std::string hash;
  for (const char* robot : {"a", "b", "c", "d"}) {
    const std::string text = slurp(dir / (std::string(robot) + ".json"));
    const Json run = Json::parse(text, nullptr, false);
    ASSERT_FALSE(run.is_discarded()) << robot << ": " << slurp(dir / (std::string(robot) + ".err"));
    EXPECT_EQ(run["result"]["status"], "explored") << robot;
    const Json& link = run["result"]["link"][robot];
    if (hash.empty()) hash = link["map_hash"];
    EXPECT_EQ(link["map_hash"], hash) << robot;
    if (std::getenv("OUTRIDER_SHOW") != nullptr) std::fprintf(stderr, "%s %s: %s\n", GetParam(), robot, link.dump().c_str());
    if (std::string(GetParam()) == "interface" && robot == std::string("b")) {
      EXPECT_GT(link["reopened"].get<int>(), 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Breaks, Networks, testing::Values("cut", "halves", "interface"),
                         [](const auto& instance) { return std::string(instance.param); });

}  // namespace
}  // namespace outrider::test
