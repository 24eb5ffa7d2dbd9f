// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <map>

#include "common/bus/virtual_bus.hpp"
#include "common/messages/blank.hpp"
#include "common/messages/ins_messages.hpp"
#include "modules/scan_matching/scan_matching_node.hpp"
#include "tests/helpers.hpp"
#include "tests/scan_matching/simulated_drive.hpp"

namespace tread::scan_matching {
namespace {

using testing::kSecond;

scan_t messageFrom(const sim::LaserScan& scan, const sim::LaserParameters& laser, int64_t seq) {
  auto message = blank<scan_t>();
  message.utime = scan.utime;
  message.seq = seq;
  for (int i = 0; i < 3; ++i) message.sensor_position[i] = laser.mounting.p_body[i];
  const double level[4] = {1.0, 0.0, 0.0, 0.0};
  std::copy(std::begin(level), std::end(level), message.sensor_orientation);
  message.duration = static_cast<int32_t>(scan.sweep_us);
  message.angle_first = scan.angle_min;
  message.angle_step = scan.angle_step;
  message.range_min = laser.range_min;
  message.range_max = laser.range_max;
  message.ranges = scan.ranges;
  message.num_beams = static_cast<int32_t>(scan.ranges.size());
  return message;
}

/// The real node with the simulated robot, and its published messages.
struct NodeRun {
  explicit NodeRun(sim::WorldDescription world, ScanMatchingConfig config = {}) {
    settings.start_utime = bus.now();
    robot = std::make_unique<sim::SimulatedRobot>(
        std::make_shared<const sim::World>(std::move(world)), settings);
    bus.addNode("scan_matching",
                [config](Bus& end) { return std::make_unique<ScanMatchingNode>(config, end); });
    bus.outside().subscribe<ins_t>(kIns, [this](const ins_t& message) {
      if (message.satellites == -1) heard.push_back(message);
    });
    bus.outside().subscribe<health_t>(kHealth, [this](const health_t& message) {
      health = message;
      for (const counter_t& counter : message.counters)
        counters[counter.counter_name] = counter.counted;
    });
  }
  void runFor(double seconds, const sim::MotorPower& power) {
    const int64_t end = bus.now() + std::llround(1e6 * seconds);
    robot->setPower(power);
    while (bus.now() < end) {
      bus.runUntil(bus.now() + 10'000);
      robot->advanceTo(bus.now());
      for (const sim::LaserScan& scan : robot->takeScans()) {
        scan_t message = messageFrom(scan, settings.laser, seq++);
        if (change) change(message);
        bus.outside().publish(kScan, message);
      }
    }
  }

  VirtualBus bus{0};
  sim::RobotSettings settings = sim::shippedRobot();
  std::unique_ptr<sim::SimulatedRobot> robot;
  std::vector<ins_t> heard;
  health_t health;
  std::map<std::string, int64_t> counters;
  std::function<void(scan_t&)> change;
  int64_t seq = 0;
};

}  // namespace

TEST_CASE("SCAN becomes INS as a robot's processes take it") {
  NodeRun run(yard());
  run.runFor(4.0, {0.8, 0.7});
  REQUIRE(run.heard.size() >= 38);
  CHECK((run.heard.front().ins_status & ins_t::STATUS_JUMP) != 0);
  for (size_t i = 1; i < run.heard.size(); ++i) {
    const ins_t& message = run.heard[i];
    CHECK(message.ins_status == ins_t::STATUS_NO_ATTITUDE);
    CHECK(message.seq == run.heard[i - 1].seq + 1);
    CHECK(message.utime > run.heard[i - 1].utime);
    CHECK(spatialPose(message));
    CHECK(planarTwist(message));
    CHECK(horizontalStd(message) > 0.0);
    CHECK(std::isnan(message.position_std[2]));
    CHECK(std::isnan(message.rate[0]));
  }
  const auto pose = planarPose(run.heard.back());
  const Pose2 truth = run.robot->truth().T_map_body;
  CHECK(distanceBetween(*pose, truth) < 0.15);  // .1 s later, at 1 m/s
  CHECK(run.heard.back().velocity[0] == Approx(run.robot->truth().v_body.v_x).margin(0.1));
  CHECK(run.health.health_state == health_t::HEALTH_OK);
  CHECK(run.counters.at("scans matched") >= 37);
}

TEST_CASE("for an INS driver it publishes SCAN_MATCHING, and bears an INS beside it") {
  ConfigReader reader = ConfigReader::fromText("channel: SCAN_MATCHING", "test");
  NodeRun run(yard(), readScanMatchingConfig(reader));
  int poses = 0;
  run.bus.outside().subscribe<ins_t>(
      kScanMatching, [&](const ins_t& message) { poses += planarPose(message) ? 1 : 0; });
  auto other = blank<ins_t>();
  other.satellites = 12;
  for (int i = 0; i < 20; ++i) {
    run.runFor(0.1, {0.8, 0.7});
    other.utime = run.bus.now();
    run.bus.outside().publish(kIns, other);
  }
  CHECK(poses >= 17);
  CHECK(run.heard.empty());
  CHECK(run.health.health_state == health_t::HEALTH_OK);
}

TEST_CASE("on hills what is seen only from afar is doubted") {
  const auto sweep = [](const std::string& yaml) {
    ConfigReader reader = ConfigReader::fromText(yaml, "test");
    ReceivedScan scan;
    scan.T_body_sensor = Eigen::Translation3d(0.2, 0.0, 0.5);
    std::string refusal;
    return sweepOf(scan, readScanMatchingConfig(reader), refusal)->trusted_range;
  };
  CHECK(std::isinf(sweep("{}")));
  CHECK(sweep("ground_tilt: 0.1") == Approx(5.0));
}

TEST_CASE("without a SCAN, or in an open field, HEALTH says why there is no pose") {
  NodeRun field({});
  field.runFor(2.5, {0.5, 0.5});
  REQUIRE_FALSE(field.heard.empty());
  for (const ins_t& message : field.heard) {
    CHECK((message.ins_status & ins_t::STATUS_NO_POSITION) != 0);
    CHECK_FALSE(planarPose(message));
    CHECK_FALSE(planarTwist(message));
  }
  CHECK(field.health.health_state == health_t::HEALTH_DEGRADED);
  CHECK(field.health.health_reason.find("an open field?") != std::string::npos);
  CHECK(field.counters.at("matches refused: too few points in sight") > 15);
  field.bus.runUntil(field.bus.now() + 3 * kSecond);
  CHECK(field.health.health_reason.find("no SCAN for") != std::string::npos);
}

TEST_CASE("broken scans, scans of the ground and another INS are counted or told") {
  NodeRun run(yard());
  run.change = [](scan_t& message) { message.range_max = testing::kNan; };
  run.runFor(0.5, {});
  CHECK(run.heard.empty());
  run.change = [](scan_t& message) {
    message.sensor_orientation[0] = std::cos(0.2);
    message.sensor_orientation[2] = std::sin(0.2);
  };
  run.runFor(1.0, {});
  CHECK(run.heard.empty());
  run.change = nullptr;
  auto other = blank<ins_t>();
  other.utime = run.bus.now() - 1;
  other.satellites = 9;
  run.bus.outside().publish(kIns, other);
  run.runFor(0.9, {});
  CHECK_FALSE(run.heard.empty());
  CHECK(run.health.health_reason.find("another process publishes INS") != std::string::npos);
  run.runFor(2.0, {});
  CHECK(run.health.health_state == health_t::HEALTH_OK);
  CHECK(run.counters.at("scans refused: its plane is too steep") >= 8);
  CHECK(run.counters.count(
      "scans refused: range limits are not 0 <= range_min < range_max <= 1000 m"));
}

TEST_CASE(
    "the shipped configuration of scan matching is read, what is out of range is told with its "
    "line") {
  ConfigReader shipped = ConfigReader::fromFile(
      TREAD_SOURCE_DIR "/config/robots/teodor_without_ins/scan_matching.yaml");
  const ScanMatchingConfig config = readScanMatchingConfig(shipped);
  CHECK(config.matcher.points.range_max == 15.0);
  ConfigReader wrong = ConfigReader::fromText("start: [0, 0, 0]\nmin_overlap: 2\n", "s.yaml");
  CHECK_THROWS_WITH(readScanMatchingConfig(wrong), Catch::Contains("s.yaml:2"));
  ConfigReader unknown = ConfigReader::fromText("speed: 2\n", "s.yaml");
  CHECK_THROWS_AS(readScanMatchingConfig(unknown), ConfigError);
}

}  // namespace tread::scan_matching
