// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <random>

#include "common/soundness/core/drive.hpp"
#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model_document.hpp"
#include "common/vehicle/omni_kernel.hpp"

namespace tread::gap {

/// Noise of a synthetic drive.
struct SyntheticNoise {
  double gyro = 0.015;     ///< [rad/s] per quarter of a second
  double fix = 0.01;       ///< [m]
  double heading = 0.003;  ///< [rad]
  double ground = 0.03;    ///< [1] of speed and yaw rate, per pattern; half of it is correlated
};

/// A random command over all that the vehicle accepts, with speeds up to 1.
template <class Random>
Command drawnCommand(const VehicleModel& vehicle, Random& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  if (vehicle.isOmni()) {
    const double way = kPi * uniform(random), speed = 0.6 * std::abs(uniform(random));
    const double turn = 0.4 * uniform(random) / vehicle.wheels.radius();
    const bool straight = uniform(random) < -0.6;
    return vehicle.wheels.speeds(
        {speed * std::cos(way), speed * std::sin(way), straight ? 0.0 : turn});
  }
  if (vehicle.isCar()) {
    const double throttle = uniform(random), angle = 0.45 * uniform(random);
    return {throttle, uniform(random) < -0.8 ? 0.0 : angle};
  }
  TrackCommand command{uniform(random), uniform(random)};
  if (uniform(random) < -0.8) command.right = command.left;
  if (uniform(random) < -0.8) command.right = -command.left;
  return command;
}

inline void give(VehicleKernel& kernel, const Command& command) {
  kernel.give(command.tracks());
}
inline void give(OmniKernel& kernel, const Command& command) {
  kernel.give(command);
}

/// A drive of two-second patterns simulated by a model: commands, INS at 50 Hz, executions.
/** The kernel simulates it, so forms match exactly: it tests the mathematics, not the value of the
 * workflow (see tests/study). */
template <class Kernel>
Drive syntheticDriveBy(Kernel kernel, const ModelDocument& truth, double seconds, uint64_t seed,
                       const SyntheticNoise& noise) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gauss(0.0, 1.0);
  constexpr double kPeriod = 0.05;
  constexpr int kCommands = 40;
  constexpr double kInsPeriod = 0.02;
  const double roughness = noise.ground * std::sqrt(0.5);
  Drive drive;
  drive.name = "synthetic";
  drive.layout = truth.vehicle.layout();
  Segment segment;
  std::vector<MotionSample> motion{{0.0, Pose2{}, 0.0}};
  double time = 0.0;
  double slow_v = gauss(random), slow_w = gauss(random);
  std::vector<DriveContext> contexts;
  while (time < seconds - 1e-9) {
    const Command command = drawnCommand(truth.vehicle, random);
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
      give(kernel, command);
      kernel.hold(kPeriod, context);
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

inline Drive syntheticDrive(const ModelDocument& truth, double seconds, uint64_t seed,
                            const SyntheticNoise& noise = {}) {
  if (truth.vehicle.isOmni())
    return syntheticDriveBy(OmniKernel(truth.vehicle, {}), truth, seconds, seed, noise);
  return syntheticDriveBy(VehicleKernel(truth.vehicle, EntryState{}), truth, seconds, seed, noise);
}

/// A car of 1 m/s with a wheelbase of .9 m.
inline ModelDocument syntheticCar() {
  ModelDocument model;
  model.vehicle.name = "synthetic car";
  model.vehicle.gauge = 0.7;
  model.vehicle.wheelbase = 0.9;
  model.vehicle.lag = 0.2;
  model.vehicle.steering_lag = 0.15;
  model.vehicle.forward_gain = 0.95;
  return model;
}

/// A holonomic base with three wheels, .4 m from its centre.
inline ModelDocument syntheticOmni() {
  ModelDocument model;
  model.vehicle.name = "synthetic omni";
  model.vehicle.kind = CommandKind::kTrackSpeed;
  std::vector<OmniWheel> wheels;
  for (const double angle : {kPi / 3.0, kPi, -kPi / 3.0})
    wheels.push_back({0.4 * std::cos(angle), 0.4 * std::sin(angle), angle + kPi / 2.0, 0.0});
  std::string why;
  model.vehicle.wheels = *OmniWheels::make(std::move(wheels), why);
  model.vehicle.gauge = 2.0 * model.vehicle.wheels.radius();
  model.vehicle.lag = 0.15;
  model.vehicle.forward_gain = model.vehicle.sideways_gain = model.vehicle.yaw_gain = 0.9;
  return model;
}

/// A vehicle of 1 m/s with .8 m between its tracks.
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
