// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/model_vehicle.hpp"

#include <algorithm>
#include <cmath>

namespace tread::sim {
namespace {

constexpr double kMemory = 4.0;  // [s], longer than both latencies together
constexpr size_t kMostRemembered = 1000;

constexpr int kStepsPerNoise = 10;
constexpr double kNoiseStep = 0.01;      // [s], a multiple of the simulator's step
constexpr double kFullCurrent = 11.0;    // [A] a motor at full power, see ModelVehicle
constexpr double kLoadCurrent = 200.0;   // [A s/m] per speed lost to the ground: 4000 N s/m
constexpr double kCurrentLimit = 125.0;  // [A] of the power stage
constexpr uint64_t kModelStream =
    20;  // of random numbers, separate from those of robot and devices

}  // namespace

void ModelIns::remember(const MotionSample& now, const InsInput& truth) {
  motion_.push_back(now);
  truths_.push_back(truth);
  if (motion_.size() < kMostRemembered) return;
  const auto old = std::find_if(motion_.begin(), motion_.end(), [&](const MotionSample& pose) {
    return pose.time >= now.time - kMemory;
  });
  truths_.erase(truths_.begin(), truths_.begin() + (old - motion_.begin()));
  motion_.erase(motion_.begin(), old);
}

InsInput ModelIns::inputAt(double time) const {
  const auto earlier = std::find_if(motion_.rbegin(), motion_.rend(),
                                    [&](const MotionSample& pose) { return pose.time <= time; });
  if (earlier == motion_.rend()) return truths_.front();
  const size_t i = static_cast<size_t>(motion_.rend() - earlier) - 1;
  if (i + 1 == motion_.size()) return truths_.back();
  const double share = (time - motion_[i].time) / (motion_[i + 1].time - motion_[i].time);
  InsInput input = truths_[i];
  const InsInput& next = truths_[i + 1];
  input.body.p_map += share * (next.body.p_map - input.body.p_map);
  input.body.pitch += share * (next.body.pitch - input.body.pitch);
  input.body.roll += share * (next.body.roll - input.body.roll);
  input.v_body += share * (next.v_body - input.v_body);
  input.rate_body += share * (next.rate_body - input.rate_body);
  return input;
}

InsInput ModelIns::sensed(int64_t utime, const InsInput& truth) {
  const double now = static_cast<double>(utime - start_utime_) * 1e-6;
  const Eigen::Vector3d& p_map = truth.body.p_map;
  remember({now, {p_map.x(), p_map.y(), truth.yaw}, truth.rate_body.z()}, truth);
  const MotionSample said = measuredAt(motion_, measurement_, now);
  const double then = now - measurement_.ins_latency;
  InsInput input = inputAt(then);
  const double omega = yawRateAt(motion_, then);
  const double ahead = poseAt(motion_, then).yaw - said.T_map_body.yaw;
  const double scale = 1.0 + measurement_.position_scale;
  const double v_x = scale * (input.v_body.x() + measurement_.lever_arm_y * omega);
  const double v_y = scale * (input.v_body.y() - measurement_.lever_arm_x * omega);
  const double c = std::cos(ahead), s = std::sin(ahead);
  input.v_body.x() = c * v_x - s * v_y;
  input.v_body.y() = s * v_x + c * v_y;
  input.body.p_map.x() = said.T_map_body.x;
  input.body.p_map.y() = said.T_map_body.y;
  input.yaw = said.T_map_body.yaw;
  input.rate_body.z() = said.omega;
  return input;
}

ModelVehicle::ModelVehicle(const ModelDocument& document, std::optional<uint64_t> noise_seed,
                           double top_speed, double max_steering)
    : model_(document.vehicle),
      full_command_(model_.kind == CommandKind::kTrackSpeed ? top_speed : 1.0),
      max_steering_(max_steering),
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
  TrackCommand command{std::clamp(power.left, -full_command_, full_command_),
                       std::clamp(power.right, -full_command_, full_command_)};
  if (model_.isCar()) command.right = max_steering_ * std::clamp(power.right, -1.0, 1.0);
  DriveContext context;
  context.session_time = session_time_;
  context.battery_drop = 1.0 - battery_.voltage / drive_.full_voltage;
  // The attitude of a body on this plane, as in poseOnGround().
  context.pitch = -std::atan(ground.slope_along);
  context.roll = std::atan(ground.slope_across / std::hypot(1.0, ground.slope_along));
  const Pose2 T_start_before = kernel_.pose();
  kernel_.step(command, dt, context);
  session_time_ += dt;
  const Pose2 moved = between(T_start_before, kernel_.pose());
  v_body_ = {moved.x / dt, moved.y / dt, moved.yaw / dt};
  mean_.step(command, dt, context);
  asked_.include(mean_.twist());
  drawCurrent(command, dt);
}

void ModelVehicle::varyNoise() {
  noise_->step();
  const MotionFactors now = noise_->factors(spread_);
  kernel_.setNoise({now.forward, now.yaw, now.heading});
}

void ModelVehicle::drawCurrent(const TrackCommand& command, double dt) {
  const TrackCommand speeds = kernel_.trackSpeeds();
  const double right = model_.isCar() ? 0.0 : command.right;
  const TrackCommand power{command.left / full_command_, right / full_command_};
  left_ = {power.left, speeds.left, kFullCurrent * power.left};
  right_ = {power.right, speeds.right, kFullCurrent * power.right};
  stepBattery(drive_, left_, right_, dt, battery_);
  // Speed lost to the ground is load; speed that the drive does not give is none.
  const double per_speed = kFullCurrent / (takesSpeeds() ? full_command_ : model_.full_speed);
  const double forward = model_.forward_gain * (speeds.left + speeds.right) / 2.0 - v_body_.v_x;
  const double turning =
      model_.yaw_gain * (speeds.right - speeds.left) / 2.0 - v_body_.omega * model_.gauge / 2.0;
  const auto drawn = [&](double speed, double lost) {
    return std::clamp(per_speed * speed + kLoadCurrent * lost, -kCurrentLimit, kCurrentLimit);
  };
  left_.current = drawn(speeds.left, forward - turning);
  right_.current = drawn(speeds.right, forward + turning);
}

std::string ModelVehicle::warning() const {
  if (!known_) return {};
  std::string line;
  for (const std::string& warning : warningsOutside(*known_, asked_))
    line += (line.empty() ? "model " + model_.name + ": " : "; ") + warning;
  return line;
}

RobotParts partsOf(const ModelDocument& document, const RobotSettings& settings) {
  RobotParts parts;
  std::optional<uint64_t> noise_seed;
  if (settings.motion_noise) noise_seed = streamSeed(settings.seed, kModelStream);
  parts.vehicle = std::make_unique<ModelVehicle>(
      document, noise_seed, settings.wiring.top_speed.value_or(1.0), settings.vehicle.max_steering);
  if (!isPerfect(document.measurement))
    parts.ins_errors = std::make_unique<ModelIns>(document.measurement, settings.start_utime);
  return parts;
}

}  // namespace tread::sim
