// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/kernel.hpp"

#include <algorithm>
#include <cmath>

namespace tread {
namespace {

constexpr double kMaxStep = 0.005;       // [s]
constexpr double kShortestStep = 1e-12;  // [s], below it is rounding of time

/// A track that follows its target for dt: mean speed meanwhile and speed at the end.
struct Lagged {
  double mean;
  double end;
};

Lagged follow(double speed, double target, double lag, double dt) {
  if (lag <= 0.0) return {target, target};
  const double decay = std::exp(-dt / lag);
  const double distance = speed - target;
  return {target + distance * (1.0 - decay) * lag / dt, target + distance * decay};
}

}  // namespace

EntryState steadyEntry(const VehicleModel& model, const TrackCommand& command) {
  return {model.trackSpeeds(command), command};
}

Twist2 steadyTwist(const VehicleModel& model, const TrackCommand& command) {
  return model.motionAt(model.trackSpeeds(command), {}).v_body;
}

VehicleKernel::VehicleKernel(const VehicleModel& model, const EntryState& entry,
                             const ExecutionNoise& noise)
    : model_(model), noise_(noise), track_speeds_(entry.track_speeds), acting_(entry.command) {}

void VehicleKernel::step(const TrackCommand& command, double duration) {
  waiting_.push_back({time_ + model_.delay, command});
  const double end = time_ + duration;
  while (!waiting_.empty() && waiting_.front().until < end - kShortestStep) {
    advance(waiting_.front().until - time_);
    acting_ = waiting_.front().command;
    waiting_.pop_front();
  }
  advance(end - time_);
  time_ = end;
}

void VehicleKernel::advance(double duration) {
  if (duration < kShortestStep) return;
  const TrackCommand target = model_.trackSpeeds(acting_);
  const int steps = std::max(1, static_cast<int>(std::ceil(duration / kMaxStep - 1e-6)));
  const double dt = duration / steps;
  for (int i = 0; i < steps; ++i) {
    const Lagged left = follow(track_speeds_.left, target.left, model_.lag, dt);
    const Lagged right = follow(track_speeds_.right, target.right, model_.lag, dt);
    const Twist2 v_body = model_.motionAt({left.mean, right.mean}, noise_).v_body;
    T_start_body_ = T_start_body_ * integrate(v_body, dt);
    track_speeds_ = {left.end, right.end};
  }
  time_ += duration;
}

std::vector<Pose2> simulate(const VehicleModel& model, const std::vector<TrackCommand>& commands,
                            double period, const EntryState& entry, const ExecutionNoise& noise) {
  VehicleKernel kernel(model, entry, noise);
  std::vector<Pose2> poses;
  poses.reserve(commands.size());
  for (const TrackCommand& command : commands) {
    kernel.step(command, period);
    poses.push_back(kernel.pose());
  }
  return poses;
}

}  // namespace tread
