// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <deque>

#include "common/geometry/se2.hpp"
#include "common/pattern/command.hpp"
#include "common/vehicle/model.hpp"

namespace tread {

/// Drives the model of a holonomic base through commands; deterministic, without a clock.
/** The commands act after the model's delay; the rims follow them with its lag, all alike, so that
 * the twist which they lead to does; on the ground
 *
 *     v_x = forward_gain v_x',  v_y = sideways_gain v_y',  omega = yaw_gain omega'
 *
 * Chance scales and turns the translation, and scales the yaw rate. The effects of the catalogue
 * are of two tracks: a model with wheels has none. */
class OmniKernel {
 public:
  /// `entry`: the command that was held for long.
  OmniKernel(const VehicleModel& model, const Command& entry, const ExecutionNoise& noise = {});

  /// Holds a command for `duration` [s].
  void step(const Command& command, double duration);

  /// Pose relative to the start, yaw unwrapped.
  const Pose2& pose() const { return T_start_body_; }
  /// Body twist at this moment.
  Twist2 twist() const { return onGround(driven_); }

 private:
  struct Waiting {
    double until;  ///< [s] since the start; it begins to act then
    Command command;
  };

  void advance(double duration);
  Twist2 asked(const Command& command) const;
  Twist2 onGround(const Twist2& driven) const;

  VehicleModel model_;
  ExecutionNoise noise_;
  Pose2 T_start_body_;
  Twist2 driven_;  ///< of the rims, behind their lag, as if nothing slipped
  Twist2 asked_;   ///< of the command that acts
  std::deque<Waiting> waiting_;
  double time_ = 0.0;
};

}  // namespace tread
