// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <random>
#include <string>
#include <vector>

#include "common/recordings/imported_log.hpp"
#include "common/vehicle/kernel.hpp"
#include "tools/lab/replay/learner_replay.hpp"

namespace tread::samples {

/// A two-track vehicle with track speed commands and no lag.
inline VehicleModel plainModel(double forward_gain, double yaw_gain) {
  VehicleModel model;
  model.name = "plain";
  model.kind = CommandKind::kTrackSpeed;
  model.gauge = 1.0;
  model.forward_gain = forward_gain;
  model.yaw_gain = yaw_gain;
  return model;
}

/// Random turns of six seconds each for a vehicle with these gains, in the recordings' format.
inline recordings::RecordedDrive syntheticRecording(const VehicleModel& truth, int steps,
                                                    uint64_t seed = 1) {
  recordings::RecordedDrive recording;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> speed(0.6, 1.2);
  std::uniform_real_distribution<double> turn(-0.5, 0.5);
  for (int step = 1; step <= steps; ++step) {
    const double begin = 8.0 * step;
    const double v = speed(random);
    const double w = turn(random);
    const TrackCommand command{v - w / 2.0, v + w / 2.0};
    VehicleKernel vehicle(truth, steadyEntry(truth, command));
    for (int i = 0; i <= 120; ++i) {
      const double time = begin + 0.05 * i;
      recordings::Fix fix;
      fix.time = time;
      fix.T_map_body = vehicle.pose();
      fix.new_track = i == 0;
      recording.fixes.push_back(fix);
      recordings::DriveSample sample;
      sample.time = time;
      sample.command = sample.speed = command;
      recording.drive.push_back(sample);
      vehicle.step(command, 0.05);
    }
    recording.runs.push_back({step, begin, begin + 6.05, "the recording of the step ends"});
  }
  return recording;
}

inline DriveLog syntheticLog(const recordings::RecordedDrive& recording) {
  recordings::Session session;
  session.name = "synthetic";
  session.robot = "a model";
  session.surface = "ice";
  session.pose_rate = 20.0;
  recordings::ImportCounts counts;
  return replay::toLearnerLog("synthetic",
                              recordings::makeLog(recording, session, "steps", {}, counts));
}

}  // namespace tread::samples
