// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <deque>
#include <optional>

#include "common/geometry/se2.hpp"
#include "common/pattern/command.hpp"
#include "common/vehicle/model.hpp"

namespace tread {

/// Drives the model of a holonomic base through commands; deterministic, without a clock.
/** The commands act after the model's delay; each rim follows its own with the model's lag, and
 * what the effects do to a track's drive they do to a wheel's. To the rims belongs the body twist
 * v' of least squares; on the ground
 *
 *     v_x = forward_gain v_x',  v_y = sideways_gain v_y',  omega = yaw_gain omega'
 *
 * and then the effects that such a base has (Effect::isOf()) act as on tracks, those of the speed
 * on its size in whatever direction. Chance scales and turns the translation, and scales the yaw
 * rate. */
class OmniKernel {
 public:
  /// `entry`: the command held for a long time before; `rims`: rim speeds [m/s], if they are known
  /// to differ from it.
  OmniKernel(const VehicleModel& model, const Command& entry, const ExecutionNoise& noise = {},
             const DriveContext& context = {}, const std::optional<Command>& rims = {});

  /// Holds a command for `duration` [s]; the context stays, except for the session time.
  void step(const Command& command, double duration);
  /// Gives a command; it acts after the model's delay, until the next one does.
  void give(const Command& command);
  /// Continues for `duration` [s] with the commands given so far, in the context of the start.
  void hold(double duration, const DriveContext& context);

  /// Pose relative to the start, yaw unwrapped.
  const Pose2& pose() const { return T_start_body_; }
  /// Body twist at this moment.
  Twist2 twist() const;
  /// Changes the noise from now on, for noise that varies along a drive.
  void setNoise(const ExecutionNoise& noise) { noise_ = noise; }

 private:
  struct Waiting {
    double until;  ///< [s] since the start, when it begins to act
    Command command;
  };

  void hold(double duration);
  void advance(double duration);
  void integrateStep(double dt);
  /// Speeds demanded from a wheel's drive and delivered by it [m/s].
  double supplied(size_t wheel) const;
  double target(size_t wheel, double supply) const;
  /// Steady twist for given rim speeds, before the body's inertia.
  Twist2 onGround(const Command& rims, const ChangesInForce& changes) const;
  /// The body twist of a motion, including its lateral part and slopes.
  Twist2 bodyTwist(const Twist2& motion, const ChangesInForce& changes, double fastest) const;

  VehicleModel model_;
  ExecutionNoise noise_;
  DriveContext context_;
  Pose2 T_start_body_;
  std::array<TrackState, Command::kMaxChannels> rims_;
  Twist2 body_;  ///< of the body behind its inertia
  Command acting_;
  std::deque<Waiting> waiting_;
  double time_ = 0.0;
};

}  // namespace tread
