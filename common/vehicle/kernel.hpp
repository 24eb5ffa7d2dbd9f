// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/pattern/pattern.hpp"
#include "common/vehicle/model.hpp"

namespace tread {

/// In what state a vehicle begins: standing still, cold, level, at the start of a session.
struct EntryState {
  TrackCommand track_speeds{};  ///< [m/s] of the drive
  TrackCommand
      command{};  ///< given so far; it acts on until the delay of the first new one is over
  DriveContext context{};  ///< at the start
  /// Forward speed and yaw rate of the body, for its inertia; else what the tracks lead to.
  std::optional<PlaneMotion> body = std::nullopt;
  TrackCommand heat{};  ///< [1] low-pass of the duty of each side's motor, see thermal_derating
};

/// The state that a command leads to when it is held for long (motors cold).
EntryState steadyEntry(const VehicleModel& model, const TrackCommand& command,
                       const DriveContext& context = {});

/// The body twist that a command leads to when it is held for long.
Twist2 steadyTwist(const VehicleModel& model, const TrackCommand& command,
                   const DriveContext& context = {});

/// Drives a model through commands; deterministic, without a clock.
/** In which order effects act on a command: EffectValues.
 *
 * The body follows before its motion to the side is known, so that the centre of rotation belongs
 * to the true yaw rate (and icr_offset remains exactly a lever arm).
 *
 * Lags and ramps are integrated exactly over steps of at most model.step; the pose moves along
 * SE(2) exponentials of each step's mean twist. An effect that is off does not change a bit. All
 * state is the kernel's: copies continue independently. */
class VehicleKernel {
 public:
  VehicleKernel(const VehicleModel& model, const EntryState& entry,
                const ExecutionNoise& noise = {});

  /// Holds a command for `duration` [s]; the context stays, session time goes on.
  void step(const TrackCommand& command, double duration);
  /// The same with what is known of this step; its session time is that of the step's beginning.
  void step(const TrackCommand& command, double duration, const DriveContext& context);

  /// The body stands at once, as at a hard obstacle; tracks and waiting commands go on.
  void stopBody() { body_ = {}; }

  /// Pose relative to the start, yaw unwrapped.
  const Pose2& pose() const { return T_start_body_; }
  /// Body twist at this moment.
  Twist2 twist() const;
  /// Speeds of the drive, before slack and slip [m/s].
  TrackCommand trackSpeeds() const { return {left_.speed, right_.speed}; }
  /// State from which another kernel can begin (without waiting commands and slack).
  EntryState state() const;
  /// Changes the noise from now on, for noise that varies along a drive.
  void setNoise(const ExecutionNoise& noise);

 private:
  struct Waiting {
    double until;  ///< [s] since the start; it begins to act then
    TrackCommand command;
  };

  void advance(double duration);
  void integrateStep(const TrackCommand& asked, double dt);
  /// Forward speed and yaw rate of a body that follows the tracks over dt; its mean meanwhile.
  PlaneMotion moveBody(const ChangesInForce& changes, const PlaneMotion& mean, double dt);

  VehicleModel model_;
  ExecutionNoise noise_;
  DriveContext context_;
  double tan_crab_ = 0.0;
  Pose2 T_start_body_;
  TrackState left_;
  TrackState right_;
  TrackCommand on_ground_;  ///< [m/s] mean speeds of the tracks in the last step of integration
  PlaneMotion body_;
  PlaneMotion led_to_;  ///< by the tracks at the end of the last step, for the body's inertia
  TrackCommand acting_;
  std::deque<Waiting> waiting_;
  double time_ = 0.0;
};

/// Poses after each command relative to the start (the trajectory R of a pattern), each command
/// held for `period` [s].
std::vector<Pose2> simulate(const VehicleModel& model, const std::vector<TrackCommand>& commands,
                            double period, const EntryState& entry,
                            const ExecutionNoise& noise = {});

/// Covariance of the last pose of a series of commands from the model's execution spread.
/** First order: J diag(spread^2) J^T with J by central differences over one standard deviation.
 * Ground that is not the model's is not in it. */
PoseCovariance endCovariance(const VehicleModel& model, const std::vector<TrackCommand>& commands,
                             double period, const EntryState& entry);

/// The motion class that a steady command keeps up, with the model's twist.
MotionClass classOf(const VehicleModel& model, const std::string& name, const TrackCommand& steady);

/// Fills trajectory and end covariance of a pattern that was never driven, entered in a steady
/// motion.
void predict(const VehicleModel& model, double period, const MotionClass& entry,
             MotionPattern& pattern);

}  // namespace tread
