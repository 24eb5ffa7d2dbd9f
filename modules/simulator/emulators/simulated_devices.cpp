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
    const std::array<double, 2> motors = power(robot_.truth().utime);
    robot_.setPower({motors[0], motors[1]});
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

std::array<double, 2> SimulatedDevices::power(int64_t utime) {
  const MotorWiring& wiring = robot_.settings().wiring;
  std::array<double, 2> power = motor_.output(utime);
  if (wiring.left_channel == 2) std::swap(power[0], power[1]);
  if (wiring.invert_left) power[0] = -power[0];
  if (wiring.invert_right) power[1] = -power[1];
  return power;
}

void SimulatedDevices::measureDrive() {
  const MotorWiring& wiring = robot_.settings().wiring;
  const TrackDrive& left = robot_.vehicle().left();
  const TrackDrive& right = robot_.vehicle().right();
  RoboteqMeasurements seen{robot_.vehicle().battery().voltage,
                           {drivingCurrent(left), drivingCurrent(right)},
                           {wiring.invert_left ? -left.speed : left.speed,
                            wiring.invert_right ? -right.speed : right.speed}};
  if (wiring.left_channel == 2) {
    std::swap(seen.motor_current[0], seen.motor_current[1]);
    std::swap(seen.track_speed[0], seen.track_speed[1]);
  }
  motor_.measure(seen);
}

std::vector<LaserScan> SimulatedDevices::takeScans() {
  return std::exchange(scans_, {});
}

}  // namespace tread::sim
