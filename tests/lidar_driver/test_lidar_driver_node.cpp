// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>

#include "common/bus/virtual_bus.hpp"
#include "common/link/make_link.hpp"
#include "modules/lidar_driver/lidar_driver_node.hpp"

using namespace tread;
using namespace tread::lidar;

namespace {

/// As if it were next to the shipped files.
const std::string kHere = TREAD_SOURCE_DIR "/config/robots/teodor/lidar.yaml";

/// Measurements of a test's range finder, and reasons for none.
struct Script {
  std::vector<RangeScan> next;
  std::string trouble;
};

/// Returns the values of a script.
class ScriptedDevice : public ScanDevice {
 public:
  explicit ScriptedDevice(Script& script) : script_(script) {}
  void open(int64_t) override {}
  void close() override {}
  void receive(std::string_view, int64_t) override {}
  std::string poll(int64_t now) override {
    if (!script_.trouble.empty()) reasons().note(Rank::kSilent, script_.trouble, now);
    return {};
  }
  std::vector<RangeScan> take(int64_t) override { return std::exchange(script_.next, {}); }
  std::string shortcomings() const override { return {}; }

 private:
  Script& script_;
};

/// A robot's range finders, the second one facing the ground, on connected lines. Outlives the bus.
struct Finders {
  void join(VirtualBus& bus) {
    config.device.make = [this, made = 0]() mutable {
      return std::make_unique<ScriptedDevice>(made++ == 0 ? around : ground);
    };
    bus.addNode("lidar_driver", [this](Bus& end) {
      return std::make_unique<LidarDriverNode>(config, end, *line.first, ground_line.first.get());
    });
  }
  LidarDriverConfig config;
  Script around, ground;
  std::pair<std::unique_ptr<Link>, std::unique_ptr<Link>> line = makePipe(),
                                                          ground_line = makePipe();
};

RangeScan scanAt(int64_t utime) {
  RangeScan scan;
  scan.utime = utime;
  scan.angle_step = 0.01;
  scan.range_max = 30.0;
  scan.ranges.assign(100, 3.0f);
  return scan;
}

}  // namespace

TEST_CASE("lidar_driver publishes good scans with the sensor's pose and counts the refused") {
  Finders finders;
  VirtualBus bus(1);
  LidarDriverConfig& config = finders.config;
  config.mounting = {{0.25, 0.0, 0.5}, {M_PI / 2, 0.0, 0.0}};
  std::vector<scan_t> scans;
  bus.outside().subscribe<scan_t>(kScan, [&](const scan_t& scan) { scans.push_back(scan); });
  finders.join(bus);
  const int64_t start = bus.now();
  for (int i = 1; i <= 20; ++i) {
    finders.around.next = {scanAt(start + i * 100'000 - 80'000)};
    if (i == 10) finders.around.next.push_back(finders.around.next.back());
    bus.runUntil(start + i * 100'000);
  }
  REQUIRE(scans.size() == 20);
  REQUIRE(scans[3].seq == 3);
  REQUIRE(scans[0].num_beams == 100);
  REQUIRE(scans[0].sensor_position[2] == 0.5);
  REQUIRE(scans[0].sensor_orientation[0] == Approx(std::sqrt(0.5)));
  REQUIRE(scans[0].sensor_orientation[3] == Approx(std::sqrt(0.5)));
}

TEST_CASE("a silent range finder is told in one line and forgotten when it speaks again") {
  Finders finders;
  VirtualBus bus(1);
  finders.around.trouble = "cannot connect: connection refused";
  std::vector<health_t> health;
  bus.outside().subscribe<health_t>(kHealth, [&](const health_t& m) { health.push_back(m); });
  finders.join(bus);
  const int64_t start = bus.now();
  bus.runUntil(start + 3'100'000);
  REQUIRE(health.back().health_state == health_t::HEALTH_FAILED);
  REQUIRE(health.back().health_reason ==
          "tcp:192.168.0.10:10940: no scan for 3 s; cannot connect: connection refused");
  finders.around.next = {scanAt(bus.now())};
  bus.runUntil(bus.now() + 900'000);
  finders.around.next = {scanAt(bus.now())};
  bus.runUntil(bus.now() + 200'000);
  REQUIRE(health.back().health_state == health_t::HEALTH_OK);
}

TEST_CASE("a range finder whose every scan is refused is not well, and the reason is told") {
  Finders finders;
  VirtualBus bus(1);
  LidarDriverConfig& config = finders.config;
  config.limits.max_beams = 50;
  std::vector<health_t> health;
  bus.outside().subscribe<health_t>(kHealth, [&](const health_t& m) { health.push_back(m); });
  finders.join(bus);
  for (int i = 1; i <= 25; ++i) {
    finders.around.next = {scanAt(bus.now())};
    bus.runUntil(bus.now() + 100'000);
  }
  REQUIRE(health.back().health_state == health_t::HEALTH_FAILED);
  REQUIRE(health.back().health_reason ==
          "tcp:192.168.0.10:10940: no good scan for 2 s; refused: too many beams (20)");
}

TEST_CASE("ranges that leave nothing between them are refused in one line") {
  ConfigReader reader = ConfigReader::fromText("range_min: 5\nrange_max: 5\n", kHere);
  REQUIRE_THROWS_WITH(readLidarDriverConfig(reader),
                      Catch::Contains("lidar.yaml:2") && Catch::Contains("range_max"));
}

TEST_CASE("a mistyped key of lidar_driver's configuration is one line with file and line") {
  ConfigReader reader = ConfigReader::fromText("latency: 0.01\nrange_maks: 20\n", kHere);
  REQUIRE_THROWS_WITH(readLidarDriverConfig(reader),
                      Catch::Contains("lidar.yaml:2") && Catch::Contains("range_maks"));
}

TEST_CASE(
    "a second range finder at the ground has its own pose, its own clock and its own health") {
  Finders finders;
  VirtualBus bus(1);
  LidarDriverConfig& config = finders.config;
  config.mounting = {{0.25, 0.0, 0.5}, {0.0, 0.0, 0.0}};
  config.ground_mounting = Mounting{{0.25, 0.0, 0.9}, {0.0, 0.2, 0.0}};
  config.ground_address = "tcp:192.168.0.11:10940";
  std::vector<scan_t> scans;
  health_t health{};
  bus.outside().subscribe<scan_t>(kScan, [&](const scan_t& scan) { scans.push_back(scan); });
  bus.outside().subscribe<health_t>(kHealth, [&](const health_t& m) { health = m; });
  finders.join(bus);
  const int64_t start = bus.now();
  for (int i = 1; i <= 30; ++i) {
    finders.around.next = {scanAt(start + i * 100'000 - 80'000)};
    if (i <= 15) {
      // Finished later, though it began earlier.
      finders.ground.next = {scanAt(start + i * 100'000 - 90'000)};
    }
    bus.runUntil(start + i * 100'000);
  }
  REQUIRE(scans.size() == 45);
  CHECK(scans[0].sensor_position[2] == 0.5);
  CHECK(scans[1].sensor_position[2] == 0.9);
  CHECK(scans[1].sensor_orientation[2] == Approx(std::sin(0.1)));
  CHECK(scans[1].seq == 1);
  CHECK(health.health_state == health_t::HEALTH_FAILED);
  CHECK(health.health_reason.find("tcp:192.168.0.11:10940: no scan for 1 s") == 0);
}

TEST_CASE("a slice of points is published as points, those beyond the limits as no measurement") {
  Finders finders;
  VirtualBus bus(1);
  LidarDriverConfig& config = finders.config;
  config.limits = {0.5, 30.0, 4000, 3};
  std::vector<scan_t> scans;
  bus.outside().subscribe<scan_t>(kScan, [&](const scan_t& scan) { scans.push_back(scan); });
  finders.join(bus);
  RangeScan slice;
  slice.utime = bus.now() + 10'000;
  slice.duration_us = 25'000;
  slice.range_max = 130.0;
  slice.points = {{3.0F, 1.0F, -0.5F}, {0.1F, 0.1F, 0.1F}, {40.0F, 0.0F, 0.0F}};
  finders.around.next = {slice};
  bus.runUntil(bus.now() + 100'000);
  slice.utime += 60'000;
  slice.points.resize(kMostPoints + 1);
  finders.around.next = {slice};
  bus.runUntil(bus.now() + 100'000);
  REQUIRE(scans.size() == 1);
  REQUIRE(scans[0].num_points == 3);
  CHECK(scans[0].num_beams == 0);
  CHECK(scans[0].points[0] == std::vector<float>{3.0F, 1.0F, -0.5F});
  CHECK(std::isnan(scans[0].points[1][0]));
  CHECK(std::isnan(scans[0].points[2][2]));
  CHECK(scans[0].duration == 25'000);
}
