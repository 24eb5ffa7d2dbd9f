// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include <catch2/catch.hpp>

#include "modules/simulator/core/robot.hpp"
#include "tests/simulator/shipped_robot.hpp"

namespace tread::sim {
namespace {

std::shared_ptr<const World> worldOf(WorldDescription description) {
  return std::make_shared<const World>(std::move(description));
}

WorldDescription hillyWorld() {
  WorldDescription description;
  description.terrain.waves = {{0.3, {0.3, 0.1}, 0.0}, {0.2, {-0.1, 0.4}, 1.0}};
  description.regions = {stripRegion("cinder", {4.0, -20.0}, {4.0, 20.0}, 3.0)};
  description.obstacles = {boxObstacle({8.0, 3.0, 0.4}, 1.0, 2.0, 1.0),
                           discObstacle({-3.0, 4.0}, 0.5, 1.2)};
  return description;
}

template <typename Value>
void append(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

/// All bytes of the robot's devices during a drive. `slice` is the period of reading.
std::string bytesOfDrive(uint64_t seed, int64_t slice_us) {
  RobotSettings settings = shippedRobot();
  settings.seed = seed;
  SimulatedRobot robot(worldOf(hillyWorld()), settings);
  std::string bytes;
  for (int64_t t = 0; t <= 5000000; t += slice_us) {
    robot.setPower(t < 3000000 ? MotorPower{0.9, 0.8} : MotorPower{0.2, 0.9});
    robot.advanceTo(t);
    for (const InsMeasurement& sample : robot.takeInsSamples()) {
      append(bytes, sample.utime);
      append(bytes, sample.p_map.x());
      append(bytes, sample.yaw);
      append(bytes, sample.rate_body.z());
    }
    for (const LaserScan& scan : robot.takeScans()) {
      append(bytes, scan.utime);
      for (float range : scan.ranges) append(bytes, range);
    }
  }
  append(bytes, robot.truth().T_map_body);
  return bytes;
}

/// Only measurements, sorted by kind: the order between kinds depends on the period of reading.
Pose2 endOfDrive(uint64_t seed, int64_t slice_us) {
  RobotSettings settings = shippedRobot();
  settings.seed = seed;
  SimulatedRobot robot(worldOf(hillyWorld()), settings);
  for (int64_t t = 0; t <= 3000000; t += slice_us) {
    robot.setPower({0.9, 0.8});
    robot.advanceTo(t);
  }
  return robot.truth().T_map_body;
}

}  // namespace

TEST_CASE("the same seed gives the same bytes, another seed others") {
  const std::string first = bytesOfDrive(5, 10000);
  CHECK(first == bytesOfDrive(5, 10000));
  CHECK(first != bytesOfDrive(6, 10000));
}

TEST_CASE("how often the robot is asked does not change where it drives") {
  const Pose2 often = endOfDrive(9, 1000);
  const Pose2 seldom = endOfDrive(9, 50000);
  CHECK(often.x == seldom.x);
  CHECK(often.y == seldom.y);
  CHECK(often.yaw == seldom.yaw);
}

TEST_CASE("an obstacle stops the body, is counted once and can be backed away from") {
  WorldDescription description;
  description.obstacles = {boxObstacle({3.0, 0.0, 0.0}, 1.0, 4.0, 1.0)};
  RobotSettings settings = shippedRobot();
  settings.motion_noise = false;
  SimulatedRobot robot(worldOf(description), settings);
  robot.setPower({1.0, 1.0});
  robot.advanceTo(8000000);
  const double front = robot.truth().T_map_body.x + 0.65;
  CHECK(front < 2.5);
  CHECK(front > 2.45);
  REQUIRE(robot.truth().collisions.size() == 1);
  CHECK(robot.truth().collisions[0].obstacle == 0);
  CHECK(robot.truth().collisions[0].penetration > 0.0);
  CHECK(robot.truth().collisions[0].penetration < 0.02);
  robot.setPower({-1.0, -1.0});
  robot.advanceTo(11000000);
  CHECK(robot.truth().T_map_body.x < 0.5);
  robot.setPower({1.0, 1.0});
  robot.advanceTo(18000000);
  CHECK(robot.truth().collisions.size() == 2);
}

TEST_CASE("power that is not a number stands for zero") {
  SimulatedRobot robot(worldOf({}), shippedRobot());
  robot.setPower({std::nan(""), INFINITY});
  robot.advanceTo(2000000);
  CHECK(robot.truth().distance == 0.0);
}

TEST_CASE("the robot lies on the ground with the attitude of the slope") {
  const auto world = worldOf(hillyWorld());
  RobotSettings settings = shippedRobot();
  settings.start = {2.0, -3.0, 1.0};
  SimulatedRobot robot(world, settings);
  robot.setPower({0.8, 0.5});
  for (int64_t t = 0; t < 8000000; t += 250000) {
    robot.advanceTo(t);
    const RobotTruth& truth = robot.truth();
    const Eigen::Vector2d p = truth.T_map_body.position();
    CHECK(truth.body.p_map.z() == Approx(world->height(p)).margin(1e-4));
    const Eigen::Vector2d gradient = world->description().terrain.gradient(p);
    const Eigen::Vector2d ahead(std::cos(truth.T_map_body.yaw), std::sin(truth.T_map_body.yaw));
    CHECK(std::tan(-truth.body.pitch) == Approx(gradient.dot(ahead)).margin(2e-3));
    CHECK((truth.body.R_map_body.transpose() * truth.body.R_map_body - Eigen::Matrix3d::Identity())
              .norm() < 1e-12);
  }
  CHECK(robot.truth().surface != "");
}

TEST_CASE(
    "INS measurements come out in order, at their rate, after their latency, with their noise") {
  RobotSettings settings = shippedRobot();
  settings.ins.position_bias = 0.0;
  settings.ins.heading_bias = 0.0;
  settings.start = {1.0, 2.0, 3.0};
  settings.start_utime = 1000;
  SimulatedRobot robot(worldOf({}), settings);
  double square = 0.0, turn_square = 0.0;
  int64_t expected = 1000;
  int count = 0;
  for (int64_t t = 1000; t < 60000000; t += 10000) {
    robot.advanceTo(t);
    for (const InsMeasurement& sample : robot.takeInsSamples()) {
      REQUIRE(sample.utime == expected);
      REQUIRE(t - sample.utime >= settings.ins.latency_us);
      REQUIRE(t - sample.utime < settings.ins.latency_us + 10000);
      expected += settings.ins.period_us;
      square += std::pow(sample.p_map.x() - 1.0, 2);
      turn_square += std::pow(sample.yaw - 3.0, 2);
      ++count;
    }
  }
  CHECK(count > 2990);
  CHECK(std::sqrt(square / count) == Approx(settings.ins.position_noise).epsilon(0.06));
  CHECK(std::sqrt(turn_square / count) == Approx(settings.ins.heading_noise).epsilon(0.06));
}

TEST_CASE("INS velocity and rates are those of the motion") {
  RobotSettings settings = shippedRobot();
  settings.motion_noise = false;
  SimulatedRobot robot(worldOf({}), settings);
  robot.setPower({0.6, 1.0});
  robot.advanceTo(3000000);
  robot.takeInsSamples();
  const Twist2 truth = robot.truth().v_body;
  Eigen::Vector3d v_mean = Eigen::Vector3d::Zero();
  double rate_mean = 0.0, position_speed = 0.0;
  robot.advanceTo(5000000);
  const std::vector<InsMeasurement> samples = robot.takeInsSamples();
  for (const InsMeasurement& sample : samples) {
    v_mean += sample.v_body / static_cast<double>(samples.size());
    rate_mean += sample.rate_body.z() / static_cast<double>(samples.size());
  }
  CHECK(v_mean.x() == Approx(truth.v_x).margin(0.01));
  CHECK(v_mean.y() == Approx(truth.v_y).margin(0.01));
  CHECK(rate_mean == Approx(truth.omega).margin(0.005));
  const double turned = samples.back().yaw - samples.front().yaw;
  position_speed = static_cast<double>(samples.back().utime - samples.front().utime) * 1e-6;
  CHECK(turned / position_speed == Approx(truth.omega).margin(0.01));
}

TEST_CASE("the laser measures what stands around it and tells nothing from no measurement") {
  WorldDescription description;
  description.obstacles = {boxObstacle({5.25, 0.0, 0.0}, 1.0, 40.0, 1.0)};
  RobotSettings settings = shippedRobot();
  settings.laser.range_noise = 0.0;
  SimulatedRobot robot(worldOf(description), settings);
  robot.advanceTo(1000000);
  const std::vector<LaserScan> scans = robot.takeScans();
  REQUIRE(scans.size() == 10);
  for (size_t k = 0; k < scans.size(); ++k) {
    CHECK(scans[k].utime == static_cast<int64_t>(k) * 100000);
    REQUIRE(scans[k].ranges.size() == 541);
    for (size_t i = 0; i < scans[k].ranges.size(); ++i) {
      const double angle = scans[k].angle_min + static_cast<double>(i) * scans[k].angle_step;
      const double wall = 4.5 / std::cos(angle);
      if (wall > 0.0 && wall < 14.9) {
        CHECK(scans[k].ranges[i] == Approx(wall).epsilon(1e-6));
      } else {
        CHECK((std::isinf(scans[k].ranges[i]) || wall < 15.1));
      }
    }
  }
}

TEST_CASE("beams of one sweep are measured where the sensor is at their time") {
  WorldDescription description;
  description.obstacles = {boxObstacle({0.0, 12.0, 0.0}, 60.0, 1.0, 1.0)};
  RobotSettings settings = shippedRobot();
  settings.motion_noise = false;
  settings.laser.range_noise = 0.0;
  settings.laser.sweep_us = 75000;
  SimulatedRobot robot(worldOf(description), settings);
  robot.setPower({-0.4, 0.4});
  std::vector<std::pair<int64_t, BodyPose>> track;
  for (int64_t t = 0; t <= 3000000; t += 1000) {
    robot.advanceTo(t);
    track.emplace_back(t, robot.truth().body);
  }
  int checked = 0;
  for (const LaserScan& scan : robot.takeScans()) {
    for (size_t i = 0; i < scan.ranges.size(); ++i) {
      if (!std::isfinite(scan.ranges[i])) continue;
      const int64_t utime = scan.utime + scan.sweep_us * static_cast<int64_t>(i) / 540;
      const BodyPose& body = track[static_cast<size_t>((utime + 999) / 1000)].second;
      const double angle = scan.angle_min + static_cast<double>(i) * scan.angle_step;
      const Eigen::Vector3d p_sensor(scan.ranges[i] * std::cos(angle),
                                     scan.ranges[i] * std::sin(angle), 0.0);
      const Eigen::Vector3d p_map =
          body.p_map + body.R_map_body * (settings.laser.mounting.p_body + p_sensor);
      CHECK(p_map.y() == Approx(11.5).margin(0.001));
      ++checked;
    }
  }
  CHECK(checked > 3000);
}

TEST_CASE("on a slope the level laser sees the ground rise") {
  WorldDescription description;
  // A valley: the ground rises on both sides.
  description.terrain.waves = {{1.0, {0.15, 0.0}, -kPi / 2.0}};
  RobotSettings settings = shippedRobot();
  settings.laser.range_noise = 0.0;
  SimulatedRobot robot(worldOf(description), settings);
  robot.advanceTo(200000);
  const LaserScan scan = robot.takeScans().front();
  const float ahead = scan.ranges[270];
  REQUIRE(std::isfinite(ahead));
  const double z = 0.5 - 1.0;
  CHECK(-std::cos(0.15 * (0.25 + ahead)) == Approx(z).margin(0.02));
}

}  // namespace tread::sim
