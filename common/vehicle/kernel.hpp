// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <deque>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/pattern/pattern.hpp"
#include "common/vehicle/model.hpp"

namespace tread {

/// In what state a vehicle begins: standing still by default.
struct EntryState {
  TrackCommand track_speeds;  ///< [m/s]
  TrackCommand command;  ///< given so far; it acts on until the delay of the first new one is over
};

/// The state that a command leads to when it is held for long.
EntryState steadyEntry(const VehicleModel& model, const TrackCommand& command);

/// The body twist that a command leads to when it is held for long.
Twist2 steadyTwist(const VehicleModel& model, const TrackCommand& command);

/// Drives a model through commands; deterministic, without a clock.
/** Track speeds are integrated exactly (first-order lag, piecewise constant commands); the pose
 * moves along SE(2) exponentials of the mean twist of steps of at most 5 ms. Copies continue
 * independently. */
class VehicleKernel {
 public:
  VehicleKernel(const VehicleModel& model, const EntryState& entry,
                const ExecutionNoise& noise = {});

  /// Holds a command for `duration` [s].
  void step(const TrackCommand& command, double duration);

  /// Pose relative to the start, yaw unwrapped.
  const Pose2& pose() const { return T_start_body_; }
  /// Body twist at this moment.
  Twist2 twist() const { return model_.motionAt(track_speeds_, noise_).v_body; }
  const TrackCommand& trackSpeeds() const { return track_speeds_; }
  /// Changes the noise from now on, for noise that varies along a drive.
  void setNoise(const ExecutionNoise& noise) { noise_ = noise; }

 private:
  struct Waiting {
    double until;  ///< [s] since the start; it begins to act then
    TrackCommand command;
  };

  void advance(double duration);

  VehicleModel model_;
  ExecutionNoise noise_;
  Pose2 T_start_body_;
  TrackCommand track_speeds_;
  TrackCommand acting_;
  std::deque<Waiting> waiting_;
  double time_ = 0.0;
};

/// Poses after each command relative to the start (the trajectory R of a pattern), each command
/// held for `period` [s].
std::vector<Pose2> simulate(const VehicleModel& model, const std::vector<TrackCommand>& commands,
                            double period, const EntryState& entry,
                            const ExecutionNoise& noise = {});

}  // namespace tread
