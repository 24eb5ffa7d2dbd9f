// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <random>

#include "common/soundness/core/drive.hpp"
#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model_document.hpp"

namespace tread::gap {

/// How noisy a synthetic drive is.
struct SyntheticNoise {
  double gyro = 0.015;     ///< [rad/s] per quarter of a second
  double fix = 0.01;       ///< [m]
  double heading = 0.003;  ///< [rad]
  double ground = 0.03;    ///< [1] of speed and yaw rate, per pattern; half of it correlated
};

/// A drive of two-second patterns that a model makes: commands, INS at 50 Hz, executions.
/** The kernel simulates it, so that forms match exactly: for tests of the mathematics, not of what
 * the workflow is worth (tests/study is for that). */
inline Drive syntheticDrive(const ModelDocument& truth, double seconds, uint64_t seed,
                            const SyntheticNoise& noise = {}) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gauss(0.0, 1.0);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  constexpr double kPeriod = 0.05;
  constexpr int kCommands = 40;
  constexpr double kInsPeriod = 0.02;
  const double roughness = noise.ground * std::sqrt(0.5);
  Drive drive;
  drive.name = "synthetic";
  Segment segment;
  VehicleKernel kernel(truth.vehicle, EntryState{});
  std::vector<MotionSample> motion{{0.0, Pose2{}, 0.0}};
  double time = 0.0;
  double slow_v = gauss(random), slow_w = gauss(random);
  std::vector<DriveContext> contexts;
  while (time < seconds - 1e-9) {
    TrackCommand command{uniform(random), uniform(random)};
    if (uniform(random) < -0.8) command.right = command.left;
    if (uniform(random) < -0.8) command.right = -command.left;
    DriveContext context;
    context.roll = 0.087 * gauss(random);
    context.pitch = 0.087 * gauss(random);
    slow_v = 0.7 * slow_v + std::sqrt(0.51) * gauss(random);
    slow_w = 0.7 * slow_w + std::sqrt(0.51) * gauss(random);
    ExecutionNoise ground;
    ground.forward = 1.0 + roughness * (slow_v + gauss(random));
    ground.yaw = 1.0 + roughness * (slow_w + gauss(random));
    kernel.setNoise(ground);
    drive.executions.push_back({0, time, time + kCommands * kPeriod});
    for (int i = 0; i < kCommands; ++i) {
      segment.commands.push_back({time, command});
      context.session_time = time;
      kernel.step(command, kPeriod, context);
      contexts.push_back(context);
      time += kPeriod;
      motion.push_back({time, kernel.pose(), kernel.twist().omega});
    }
  }
  segment.end = time;
  const double gyro = noise.gyro * std::sqrt(0.25 / kInsPeriod);
  for (double t = 0.0; t < time; t += kInsPeriod) {
    InsSample sample;
    const MotionSample said = measuredAt(motion, truth.measurement, t);
    sample.time = t;
    sample.T_map_body = {said.T_map_body.x + noise.fix * gauss(random),
                         said.T_map_body.y + noise.fix * gauss(random),
                         said.T_map_body.yaw + noise.heading * gauss(random)};
    sample.omega = said.omega + gyro * gauss(random);
    const auto at = std::min(contexts.size() - 1, static_cast<size_t>(t / kPeriod));
    sample.roll = contexts[at].roll;
    sample.pitch = contexts[at].pitch;
    segment.ins.push_back(sample);
  }
  drive.segments.push_back(std::move(segment));
  return drive;
}

/// A vehicle of 1 m/s, .8 m between its tracks.
inline ModelDocument syntheticVehicle() {
  ModelDocument model;
  model.vehicle.name = "synthetic";
  model.vehicle.full_speed = 1.0;
  model.vehicle.gauge = 0.8;
  model.vehicle.lag = 0.2;
  model.vehicle.forward_gain = 0.95;
  model.vehicle.yaw_gain = 0.68;
  return model;
}

}  // namespace tread::gap
