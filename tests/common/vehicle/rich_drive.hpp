// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <vector>

#include "common/vehicle/kernel.hpp"

namespace tread {

/// Track speed commands, a gauge of 0.6 m, a lag, a delay and nothing else.
inline VehicleModel plainVehicle() {
  VehicleModel model;
  model.kind = CommandKind::kTrackSpeed;
  model.gauge = 0.6;
  model.lag = 0.15;
  model.delay = 0.05;
  return model;
}

/// Straight, arcs, turns on the spot, reverse, stop and start: each held for 1.5 s.
inline std::vector<TrackCommand> richCommands() {
  return {{1.0, 1.0},   {0.6, 1.0},   {1.6, 2.0}, {-0.8, 0.8}, {0.05, 0.5}, {0.0, 0.0},
          {-1.0, -1.0}, {-0.7, -1.0}, {2.0, 1.2}, {1.0, -1.0}, {0.3, 0.3},  {0.9, 1.0}};
}

/// Slopes in all directions, a falling battery.
inline DriveContext contextAt(double time) {
  return {time, 0.1 * time / 20.0, 0.1 * std::sin(time), 0.08 * std::cos(0.7 * time)};
}

/// Poses of the rich drive at 20 Hz, with session time, slopes and battery.
inline std::vector<Pose2> richDrive(const VehicleModel& model) {
  VehicleKernel kernel(model, {});
  std::vector<Pose2> poses;
  int sample = 0;
  for (const TrackCommand& command : richCommands())
    for (int i = 0; i < 30; ++i, ++sample) {
      kernel.step(command, 0.05, contextAt(0.05 * sample));
      poses.push_back(kernel.pose());
    }
  return poses;
}

}  // namespace tread
