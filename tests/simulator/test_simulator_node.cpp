// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <map>
#include <memory>
#include <sstream>

#include <catch2/catch.hpp>

#include "common/bus/virtual_bus.hpp"
#include "common/link/make_link.hpp"
#include "modules/simulator/simulator_node.hpp"
#include "tests/simulator/shipped_robot.hpp"

namespace tread::sim {
namespace {

constexpr int64_t kStart = 1'000'000;

/// A simulator on a virtual bus, with the drivers' ends of its lines.
class Bench {
 public:
  explicit Bench(uint64_t seed) : bus_(1), devices_(world(), settings(seed)) {
    std::tie(ins, ins_device_) = makePipe();
    std::tie(motor, motor_device_) = makePipe();
    std::tie(laser, laser_device_) = makePipe();
    std::tie(ground, ground_device_) = makePipe();
    bus_.addNode("simulator", [this](Bus& bus) {
      return std::make_unique<SimulatorNode>(
          devices_, bus,
          DeviceLines{*ins_device_, *motor_device_, laser_device_.get(), ground_device_.get()});
    });
  }

  /// Runs for a time [us] and collects the lines' output.
  void run(int64_t duration) {
    for (const int64_t end = bus_.now() + duration; bus_.now() < end;) {
      bus_.runUntil(bus_.now() + 10000);
      hear(*ins, ins_bytes);
      hear(*motor, motor_bytes);
      hear(*laser, laser_bytes);
      hear(*ground, ground_bytes);
    }
  }

  void command(const std::string& line) {
    motor->write(reinterpret_cast<const uint8_t*>(line.data()), line.size());
  }

  const RobotTruth& truth() const { return devices_.robot().truth(); }

 private:
  static std::shared_ptr<const World> world() {
    WorldDescription description;
    description.obstacles = {boxObstacle({6.0, 0.0, 0.0}, 0.5, 6.0, 1.0)};
    return std::make_shared<const World>(description);
  }
  static SimulatorSettings settings(uint64_t seed) {
    SimulatorSettings settings;
    settings.robot = shippedRobot();
    settings.robot.seed = seed;
    settings.robot.ground_laser = LaserParameters{};
    settings.robot.ground_laser->mounting = {{0.25, 0.0, 0.9}, {0.0, 0.2, 0.0}};
    settings.robot.start_utime = kStart;
    return settings;
  }
  static void hear(Link& line, std::string& bytes) {
    uint8_t buffer[4096];
    if (!line.isOpen()) line.reopen(0);
    while (const auto count = line.read(buffer, sizeof buffer)) {
      if (*count == 0) break;
      bytes.append(reinterpret_cast<const char*>(buffer), *count);
    }
  }

 public:
  std::unique_ptr<Link> ins, motor, laser, ground;
  std::string ins_bytes, motor_bytes, laser_bytes, ground_bytes;
  VirtualBus& bus() { return bus_; }
  SimulatedDevices& devices() { return devices_; }

 private:
  std::unique_ptr<Link> ins_device_, motor_device_, laser_device_, ground_device_;
  VirtualBus bus_;
  SimulatedDevices devices_;
};

/// The middle range of the newest scan among a line's bytes [m]; NaN if there is none.
double rangeAhead(const std::string& bytes) {
  const size_t at = bytes.rfind("99b\n");
  if (at == std::string::npos) return NAN;
  std::string values;
  std::istringstream scan(bytes.substr(at + 4));
  std::string line;
  std::getline(scan, line);  // its time
  while (std::getline(scan, line) && !line.empty()) values += line.substr(0, line.size() - 1);
  double millimetres = 0.0;
  for (const char character : values.substr(3 * 270, 3))
    millimetres = 64.0 * millimetres + (character - 0x30);
  return 1e-3 * millimetres;
}

}  // namespace

TEST_CASE("commands on the motor line move the robot, the INS line tells of it") {
  Bench bench(1);
  bench.run(500000);
  CHECK(bench.truth().distance == 0.0);
  bench.command("^ECHOF 1\r^RWD 250\r");
  for (int i = 0; i < 100; ++i) {
    bench.command("!M 800 800\r");
    bench.run(20000);
  }
  CHECK(bench.truth().distance > 1.0);
  CHECK(bench.truth().T_map_body.x > 1.0);
  CHECK(bench.motor_bytes.find("+\r+\r+\r") != std::string::npos);
  CHECK(bench.ins_bytes.find("$GPGGA") != std::string::npos);
  CHECK(bench.ins_bytes.find("$PASHR") != std::string::npos);

  // Without commands the controller's watchdog stops the motors.
  bench.run(2000000);
  const double stopped = bench.truth().distance;
  bench.run(1000000);
  CHECK(bench.truth().distance == Approx(stopped).margin(1e-6));
}

TEST_CASE("a second range finder looks at the ground ahead, on a line of its own") {
  Bench bench(1);
  const std::string start = "QT\nBM\nMD0000054001000\n";
  bench.ground->write(reinterpret_cast<const uint8_t*>(start.data()), start.size());
  bench.run(1000000);
  CHECK(bench.ground_bytes.find("99b\n") != std::string::npos);
  CHECK(bench.laser_bytes.find("99b\n") == std::string::npos);
  CHECK(rangeAhead(bench.ground_bytes) == Approx(0.9 / std::sin(0.2)).margin(0.05));
}

TEST_CASE("the laser line streams scans after MD") {
  Bench bench(1);
  const std::string start = "QT\nBM\nMD0000054001000\n";
  bench.laser->write(reinterpret_cast<const uint8_t*>(start.data()), start.size());
  bench.run(1000000);
  size_t scans = 0;
  for (size_t at = 0; (at = bench.laser_bytes.find("99b\n", at)) != std::string::npos; ++at)
    ++scans;
  CHECK(scans == 10);
  CHECK(rangeAhead(bench.laser_bytes) == Approx(5.5).margin(0.05));
}

TEST_CASE("a line that is pulled and put in again works on, and streaming has stopped") {
  Bench bench(1);
  const std::string start = "MD0000054001000\n";
  bench.laser->write(reinterpret_cast<const uint8_t*>(start.data()), start.size());
  bench.run(500000);
  CHECK_FALSE(bench.laser_bytes.empty());
  setPipeConnected(*bench.laser, false);
  setPipeConnected(*bench.ins, false);
  bench.run(300000);
  setPipeConnected(*bench.laser, true);
  setPipeConnected(*bench.ins, true);
  bench.run(300000);
  bench.laser_bytes.clear();
  bench.ins_bytes.clear();
  bench.run(500000);
  CHECK(bench.laser_bytes.empty());
  CHECK(bench.ins_bytes.find("$GPGGA") != std::string::npos);
}

TEST_CASE("robot and devices outlive the node, which goes on where it was") {
  Bench bench(1);
  bench.command("!M 500 500\r");
  bench.run(500000);
  bench.bus().kill("simulator");
  bench.run(500000);
  bench.bus().restart("simulator");
  bench.run(100000);
  CHECK(bench.truth().utime >= kStart + 1090000);
  CHECK(bench.truth().distance > 0.2);
}

TEST_CASE("the simulator tells its health and its world, and nothing of the truth") {
  Bench bench(7);
  std::map<std::string, int> heard;
  bench.bus().setTap(
      [&](int64_t, const char* channel, const uint8_t*, size_t) { ++heard[channel]; });
  bench.run(3000000);
  CHECK(heard["HEALTH"] >= 3);
  CHECK(heard["CONFIG"] >= 1);
  CHECK(heard.size() == 2);
}

TEST_CASE("the same seed gives the same bytes on every line") {
  const auto bytes = [](uint64_t seed) {
    Bench bench(seed);
    bench.command("^ECHOF 1\r^RWD 0\r!M 900 700\r?V\r?A\r# 50\r");
    const std::string start = "MD0000054001000\n";
    bench.laser->write(reinterpret_cast<const uint8_t*>(start.data()), start.size());
    bench.run(4000000);
    return bench.ins_bytes + bench.motor_bytes + bench.laser_bytes;
  };
  const std::string first = bytes(3);
  CHECK(first.size() > 50000);
  CHECK(first == bytes(3));
  CHECK(first != bytes(4));
}

}  // namespace tread::sim
