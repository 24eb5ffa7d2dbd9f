// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "common/geometry/track.hpp"
#include "modules/scan_matching/core/scan_matcher.hpp"
#include "modules/simulator/core/robot.hpp"
#include "tests/simulator/shipped_robot.hpp"

namespace tread::scan_matching {

/// Output of scan matching for a simulated drive, and the truth.
struct SimulatedDrive {
  std::vector<MatchedPose> poses;
  PoseTrack truth{INT64_MAX};
  double cpu_ms = 0.0;   ///< total of the matcher
  double most_ms = 0.0;  ///< maximum for one scan

  std::optional<Pose2> trueAt(int64_t utime) const { return truth.at(utime, 20'000); }
  int count(MatchOutcome outcome) const {
    return static_cast<int>(std::count_if(poses.begin(), poses.end(), [&](const MatchedPose& pose) {
      return pose.outcome == outcome;
    }));
  }
};

/// A sweep of the simulated laser, without beams that hit nothing.
inline Sweep sweepOf(const sim::LaserScan& scan, const sim::LaserParameters& laser) {
  Sweep sweep;
  sweep.first = scan.utime;
  sweep.last = scan.utime + scan.sweep_us;
  sweep.p_body_sensor = laser.mounting.p_body.head<2>();
  for (size_t i = 0; i < scan.ranges.size(); ++i) {
    if (!std::isfinite(scan.ranges[i])) continue;
    const auto share = static_cast<double>(i) / static_cast<double>(scan.ranges.size() - 1);
    const double angle = scan.angle_min + scan.angle_step * static_cast<double>(i);
    const auto range = static_cast<double>(scan.ranges[i]);
    sweep.returns.push_back(
        {sweep.p_body_sensor + range * Eigen::Vector2d(std::cos(angle), std::sin(angle)), share});
  }
  return sweep;
}

/// Drives the shipped robot (with laser and noise) through a world with a power as function of time
/// [s].
inline SimulatedDrive drive(sim::WorldDescription description, const Pose2& start, double seconds,
                            const std::function<sim::MotorPower(double)>& power,
                            ScanMatcherConfig config = {}) {
  sim::RobotSettings settings = sim::shippedRobot();
  settings.start = start;
  settings.seed = 3;
  sim::SimulatedRobot robot(std::make_shared<const sim::World>(std::move(description)), settings);
  config.start = start;
  ScanMatcher matcher(config);
  SimulatedDrive drive;
  for (int64_t t = 0; t <= std::llround(1e6 * seconds); t += 10'000) {
    robot.setPower(power(1e-6 * static_cast<double>(t)));
    robot.advanceTo(t);
    drive.truth.push(robot.truth().utime, robot.truth().T_map_body);
    for (const sim::LaserScan& scan : robot.takeScans()) {
      const std::clock_t begin = std::clock();
      drive.poses.push_back(matcher.take(sweepOf(scan, settings.laser)));
      const double took = 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
      drive.cpu_ms += took;
      drive.most_ms = std::max(drive.most_ms, took);
    }
  }
  return drive;
}

/// Forward, a turn on the spot, an arc, backwards: all kinds of motion in 25 s.
inline sim::MotorPower everything(double t) {
  if (t < 1.0) return {0.0, 0.0};
  if (t < 6.0) return {0.9, 0.9};
  if (t < 9.0) return {-0.6, 0.6};
  if (t < 14.0) return {0.9, 0.6};
  if (t < 18.0) return {0.8, 0.9};
  if (t < 22.0) return {-0.7, -0.8};
  return {0.6, -0.6};
}

/// A yard of 24 x 18 m with walls, a hut, trunks.
inline sim::WorldDescription yard() {
  using sim::boxObstacle;
  sim::WorldDescription world;
  world.obstacles = {
      boxObstacle({12.0, 0.0, 0.0}, 0.4, 18.0, 2.0), boxObstacle({-12.0, 0.0, 0.0}, 0.4, 18.0, 2.0),
      boxObstacle({0.0, 9.0, 0.0}, 24.0, 0.4, 2.0),  boxObstacle({0.0, -9.0, 0.0}, 24.0, 0.4, 2.0),
      boxObstacle({7.0, 4.0, 0.4}, 3.0, 2.0, 2.0),   sim::discObstacle({-4.0, 5.0}, 0.3, 2.0),
      sim::discObstacle({3.0, -5.0}, 0.4, 2.0),      sim::discObstacle({-6.0, -4.0}, 0.2, 2.0)};
  return world;
}

/// Two parallel walls 3 m apart, longer than the range.
inline sim::WorldDescription corridor() {
  sim::WorldDescription world;
  world.obstacles = {sim::boxObstacle({0.0, 1.7, 0.0}, 200.0, 0.4, 2.0),
                     sim::boxObstacle({0.0, -1.7, 0.0}, 200.0, 0.4, 2.0)};
  return world;
}

}  // namespace tread::scan_matching
