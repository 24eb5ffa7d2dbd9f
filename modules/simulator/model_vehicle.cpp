// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/model_vehicle.hpp"

#include <algorithm>
#include <cmath>

#include "modules/simulator/model_ins.hpp"

namespace tread::sim {
namespace {

constexpr int kStepsPerNoise = 10;
constexpr double kNoiseStep = 0.01;    // [s], of so many steps of the simulator
constexpr double kFullCurrent = 11.0;  // [A] a motor at full power, see ModelVehicle
constexpr uint64_t kModelStream = 20;  // of random numbers, beside those of robot and devices

}  // namespace

ModelVehicle::ModelVehicle(const ModelDocument& document, std::optional<uint64_t> noise_seed)
    : name_(document.vehicle.name),
      kernel_(document.vehicle, EntryState{}),
      mean_(document.vehicle, EntryState{}),
      known_(document.envelope),
      spread_{document.vehicle.spread.forward, document.vehicle.spread.yaw,
              document.vehicle.spread.crab} {
  if (noise_seed) noise_.emplace(*noise_seed, kNoiseStep);
  battery_.voltage = drive_.full_voltage;
}

void ModelVehicle::step(const MotorPower& power, const Ground& ground, double dt) {
  if (noise_ && steps_ % kStepsPerNoise == 0) varyNoise();
  ++steps_;
  const MotorPower clamped{std::clamp(power.left, -1.0, 1.0), std::clamp(power.right, -1.0, 1.0)};
  DriveContext context;
  context.session_time = session_time_;
  context.battery_drop = 1.0 - battery_.voltage / drive_.full_voltage;
  // The attitude of a body on this plane, as poseOnGround() has it.
  context.pitch = -std::atan(ground.slope_along);
  context.roll = std::atan(ground.slope_across / std::hypot(1.0, ground.slope_along));
  const Pose2 T_start_before = kernel_.pose();
  kernel_.step({clamped.left, clamped.right}, dt, context);
  session_time_ += dt;
  const Pose2 moved = between(T_start_before, kernel_.pose());
  v_body_ = {moved.x / dt, moved.y / dt, moved.yaw / dt};
  mean_.step({clamped.left, clamped.right}, dt, context);
  asked_.include(mean_.twist());
  drawCurrent(clamped, dt);
}

void ModelVehicle::varyNoise() {
  noise_->step();
  const MotionFactors now = noise_->factors(spread_);
  kernel_.setNoise({now.forward, now.yaw, now.heading});
}

void ModelVehicle::drawCurrent(const MotorPower& power, double dt) {
  const TrackCommand speeds = kernel_.trackSpeeds();
  left_ = {power.left, speeds.left, kFullCurrent * power.left};
  right_ = {power.right, speeds.right, kFullCurrent * power.right};
  stepBattery(drive_, left_, right_, dt, battery_);
}

std::string ModelVehicle::warning() const {
  if (!known_) return {};
  std::string line;
  for (const std::string& warning : warningsOutside(*known_, asked_))
    line += (line.empty() ? "model " + name_ + ": " : "; ") + warning;
  return line;
}

RobotParts partsOf(const ModelDocument& document, const RobotSettings& settings) {
  RobotParts parts;
  std::optional<uint64_t> noise_seed;
  if (settings.motion_noise) noise_seed = streamSeed(settings.seed, kModelStream);
  parts.vehicle = std::make_unique<ModelVehicle>(document, noise_seed);
  if (!isPerfect(document.measurement))
    parts.ins_errors = std::make_unique<ModelIns>(document.measurement, settings.start_utime);
  return parts;
}

}  // namespace tread::sim
