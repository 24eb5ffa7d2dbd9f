// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/simulated_devices.hpp"

#include <cmath>
#include <utility>

namespace tread::sim {
namespace {

constexpr int64_t kStepUs = 1000;
constexpr uint64_t kInsStream = 10;  // of random numbers, beside those of the robot
constexpr uint64_t kLaserStream = 11;
/// Scans kept for a reader that does not come; older ones are dropped.
constexpr size_t kMostScans = 20;

/// Positive where the motor drives, negative where it brakes.
double drivingCurrent(const TrackDrive& track) {
  return std::copysign(1.0, track.power) * track.current;
}

}  // namespace

SimulatedDevices::SimulatedDevices(std::shared_ptr<const World> world,
                                   const SimulatorSettings& settings, RobotParts parts)
    : robot_(std::move(world), settings.robot, std::move(parts)),
      ins_(settings.ins, streamSeed(settings.robot.seed, kInsStream)),
      motor_(settings.motor),
      laser_(scipSettingsOf(settings.robot.laser), streamSeed(settings.robot.seed, kLaserStream)) {
  measureDrive();
}

void SimulatedDevices::advanceTo(int64_t utime) {
  while (robot_.truth().utime + kStepUs <= utime) {
    const std::array<double, 2> power = motor_.output(robot_.truth().utime);
    robot_.setPower({power[0], power[1]});
    robot_.advanceTo(robot_.truth().utime + kStepUs);
    measureDrive();
  }
  for (const InsSample& sample : robot_.takeInsSamples()) ins_.add(sample);
  for (LaserScan& scan : robot_.takeScans()) {
    laser_.add(scan);
    scans_.push_back(std::move(scan));
  }
  if (scans_.size() > kMostScans) scans_.erase(scans_.begin(), scans_.end() - kMostScans);
}

void SimulatedDevices::measureDrive() {
  const TrackDrive& left = robot_.vehicle().left();
  const TrackDrive& right = robot_.vehicle().right();
  motor_.measure({robot_.vehicle().battery().voltage,
                  {drivingCurrent(left), drivingCurrent(right)},
                  {left.speed, right.speed}});
}

std::vector<LaserScan> SimulatedDevices::takeScans() {
  return std::exchange(scans_, {});
}

}  // namespace tread::sim
