// `outrider robot --body lcm` on wheels that the test turns: scans and poses in bot_core's types go out, the velocity
// commands that come back are driven, in real time.

#include <atomic>
#include <array>
#include <cmath>
#include <thread>

#include "bot_core/planar_lidar_t.hpp"
#include "bot_core/pose_t.hpp"
#include "link/lc02.hpp"
#include "link/multicast.hpp"
#include "live/rooms.hpp"
#include "outrider_wire/velocity_command_t.hpp"
#include "sim/lidar.hpp"
#include "sim/walls.hpp"
#include "sim/world.hpp"

namespace outrider::test {
namespace {

constexpr const char* kUrl = "udpm://239.255.76.67:7699?ttl=0";
constexpr const char* kRooms = R"(resolution: 0.1
map:
##############################
#..........#.................#
#..........#.................#
#..........#.................#
#..........#.................#
#..........#.................#
#..........#.................#
#............................#
#....0.......................#
#............................#
#............................#
#............................#
#..........#.................#
#..........#.................#
#..........#.................#
##############################
)";

/// A differential drive in a world, behind the driver messages that LCM users have.
class Driver {
 public:
  explicit Driver(const sim::World& world, const RobotSpec& spec)
      : walls_(world.map, spec.radius), solid_(sim::solid_world(world.map)), lidar_(spec, 0.0, 1), pose_(spec.start) {
    std::string why;
    socket_ = link::MulticastSocket::open(link::MulticastUrl::parse(kUrl), why);
  }
  bool open() const { return socket_.has_value(); }
  int commands() const { return commands_; }
  int bumps() const { return bumps_; }
  std::string where() const { return std::to_string(pose_.x) + ", " + std::to_string(pose_.y); }

  /// Until `over`. A pose and a scan every tenth of a second.
  void drive(const std::atomic<bool>& over) {
    for (int tick = 0; !over; ++tick) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      listen();
      move(0.02);
      if (tick % 5 == 0) tell(0.02 * tick);
    }
  }

 private:
  void listen() {
    std::array<std::uint8_t, 65536> buffer;
    while (const auto size = socket_->receive(buffer)) {
      const auto frame = link::parse_lc02({buffer.data(), *size});
      const auto* message = std::get_if<link::Lc02>(&frame);
      if (message == nullptr || message->channel != "VELOCITY") continue;
      outrider_wire::velocity_command_t command{};
      if (command.decode(message->payload.data(), 0, static_cast<int>(message->payload.size())) < 0) continue;
      linear_ = command.linear;
      angular_ = command.angular;
      ++commands_;
    }
  }
  void move(double dt) {
    pose_.theta += angular_ * dt;
    const Point from = pose_.position(), to = pose_ * Point{linear_ * dt, 0.0};
    if (linear_ == 0.0) return;
    if (walls_.free_length(from, to) < distance(from, to)) ++bumps_;
    else pose_ = {to.x, to.y, pose_.theta};
  }
  void tell(double t) {
    bot_core::pose_t pose{};
    pose.utime = static_cast<std::int64_t>(1e6 * t);
    pose.pos[0] = pose_.x;
    pose.pos[1] = pose_.y;
    pose.orientation[0] = std::cos(pose_.theta / 2.0);
    pose.orientation[3] = std::sin(pose_.theta / 2.0);
    send("POSE", pose);
    const LaserScan scan = lidar_.scan(solid_, pose_, t);
    bot_core::planar_lidar_t laser{};
    laser.utime = pose.utime;
    laser.nranges = static_cast<std::int32_t>(scan.ranges.size());
    laser.ranges = scan.ranges;
    laser.rad0 = static_cast<float>(scan.angle_min);
    laser.radstep = static_cast<float>(scan.angle_increment);
    send("LASER", laser);
  }
  template <class Wire>
  void send(const char* channel, const Wire& wire) {
    std::vector<std::uint8_t> payload(static_cast<std::size_t>(wire.getEncodedSize()));
    wire.encode(payload.data(), 0, static_cast<int>(payload.size()));
    socket_->send(link::make_lc02(++sequence_, channel, payload));
  }

  sim::Walls walls_;
  OccupancyGrid solid_;
  sim::Lidar lidar_;
  Pose2 pose_;
  std::optional<link::MulticastSocket> socket_;
  double linear_ = 0.0, angular_ = 0.0;
  std::uint32_t sequence_ = 0;
  int commands_ = 0, bumps_ = 0;
};

using RealBody = SystemTest;

TEST_F(RealBody, ARobotBehindDriversExploresItsGround) {
  if (!private_network()) GTEST_SKIP() << "this kernel gives no network namespace";
  const sim::World world = sim::parse_world(kRooms, "rooms");
  spill(dir / "team.yaml", "robots:\n  - {name: a, speed: 0.5, range: 2.5, radius: 0.12}\n");
  const Point start = world.starts.front().position();
  Driver driver(world, {.name = "a", .start = {start.x, start.y, 0.0}, .range = 2.5, .radius = 0.12});
  ASSERT_TRUE(driver.open());
  std::atomic<bool> over = false;
  std::thread wheels([&] { driver.drive(over); });
  const Outcome outcome = run({"robot", "--body", "lcm", "--area", "0,0,3,1.6", "--resolution", "0.1", "--team", "team.yaml",
                               "--url", kUrl, "--max-time", "40", "-v", "--json", "--out", "run"}, {.limit = std::chrono::seconds(90)});
  over = true;
  wheels.join();
  ASSERT_EQ(outcome.code, 0) << outcome.err << outcome.out << "\n" << driver.commands() << " commands, " << driver.bumps() << " bumps; at " << driver.where();
  EXPECT_EQ(Json::parse(outcome.out)["result"]["status"], "explored");
  EXPECT_GT(driver.commands(), 10);
  EXPECT_EQ(driver.bumps(), 0);
  EXPECT_TRUE(fs::exists(dir / "run/map.pgm"));
}

}  // namespace
}  // namespace outrider::test
