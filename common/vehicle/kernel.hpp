// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/track.hpp"
#include "common/pattern/pattern.hpp"
#include "common/vehicle/added_effects.hpp"
#include "common/vehicle/model.hpp"

namespace tread {

/// The state in which a vehicle begins; default: at rest, cold, level, at the start of a session.
struct EntryState {
  TrackCommand track_speeds{};  ///< [m/s] of the drive
  /// The previous command; it acts until the delay of the first new one is over
  TrackCommand command{};
  DriveContext context{};  ///< at the start
  /// Forward speed and yaw rate of the body, for its inertia; default: those that the tracks give.
  std::optional<PlaneMotion> body = std::nullopt;
  TrackCommand heat{};  ///< [1] low-pass of the duty of each side's motor, see thermal_derating
  /// [m/s] drive targets after their ramps, see slew_limit; default: the drives' speeds.
  std::optional<TrackCommand> ramps = std::nullopt;
  std::optional<Steering> steering = std::nullopt;  ///< of a car; default: that of the command
  /// Of unnamed terms; default: the steady state of the motion at the start, turns forgotten.
  std::optional<TermMemory> memory = std::nullopt;
  AddedMemory added_memory{};  ///< of added effects of the same model; default: the steady state
};

/// The steady state of a command (motors cold).
EntryState steadyEntry(const VehicleModel& model, const TrackCommand& command,
                       const DriveContext& context = {});

/// The steady body twist of a command.
Twist2 steadyTwist(const VehicleModel& model, const TrackCommand& command,
                   const DriveContext& context = {});

/// Drives a model through commands; deterministic, without a clock.
/** For the order in which effects act on a command see EffectValues.
 *
 * The body's inertia is applied before lateral motion is computed, so that the centre of rotation
 * belongs to the true yaw rate (and icr_offset remains exactly a lever arm).
 *
 * Lags and ramps are integrated exactly over steps of at most model.step; the pose moves along
 * SE(2) exponentials of each step's mean twist. An effect that is off does not change a bit. All
 * state is the kernel's: copies continue independently. */
class VehicleKernel {
 public:
  VehicleKernel(const VehicleModel& model, const EntryState& entry,
                const ExecutionNoise& noise = {});

  /// Holds a command for `duration` [s]; the context stays, except for the session time.
  void step(const TrackCommand& command, double duration);
  /// The same with a context for this step; its session time is that of the step's beginning.
  void step(const TrackCommand& command, double duration, const DriveContext& context);
  /// Gives a command; it acts after the model's delay, until the next one does.
  void give(const TrackCommand& command);
  /// Continues for `duration` [s] with the commands given so far. A command held over many short
  /// spans costs one integration per span, whatever the delay.
  void hold(double duration, const DriveContext& context);

  /// Stops the body at once, as at a hard obstacle; tracks and delayed commands go on.
  void stopBody() { body_ = {}; }

  /// Pose relative to the start, yaw unwrapped.
  const Pose2& pose() const { return T_start_body_; }
  /// Body twist at this moment.
  Twist2 twist() const;
  /// Speeds of the drive, before slack and slip [m/s].
  TrackCommand trackSpeeds() const { return {left_.speed, right_.speed}; }
  /// Inputs of unnamed terms in the last step; not kept for a model with neither terms nor added
  /// effects of the motion.
  const TermInputs& termInputs() const { return inputs_; }
  /// State from which another kernel can continue (without delayed commands and slack).
  EntryState state() const;
  /// Changes the noise from now on, for noise that varies along a drive.
  void setNoise(const ExecutionNoise& noise);

 private:
  struct Waiting {
    double until;  ///< [s] since the start, when it begins to act
    TrackCommand command;
  };

  void hold(double duration);
  void advance(double duration);
  void integrateStep(const TrackCommand& asked, double dt);
  /// Advances a car's steering by dt; returns the mean angle of its wheels over dt [rad].
  double steer(double dt);
  /// Forward speed and yaw rate of a body that follows the tracks over dt; returns their means.
  PlaneMotion moveBody(const ChangesInForce& changes, const PlaneMotion& mean, double dt);
  /// The same inputs, with those that depend on the command.
  TermInputs withCommand(TermInputs inputs) const;
  /// Change of a motion by added effects; their memories advance by dt.
  Twist2 addedTo(const PlaneMotion& motion, const TermInputs& inputs, const ChangesInForce& changes,
                 const TrackCommand& tracks, double dt, AddedEffects& added) const;
  /// The body twist of a motion, including added effects and unnamed terms.
  Twist2 withTerms(const TermInputs& inputs, const ChangesInForce& changes,
                   const TrackCommand& tracks, PlaneMotion motion, const Twist2& added) const;
  LawInputs known(const TermInputs& inputs, const TrackCommand& tracks) const;

  /// Whether anything is added to the motion.
  bool addsToMotion() const { return !model_.unnamed.empty() || added_.changeMotion(); }

  VehicleModel model_;
  AddedEffects added_;
  ExecutionNoise noise_;
  DriveContext context_;
  double tan_crab_ = 0.0;
  Pose2 T_start_body_;
  TrackState left_;
  TrackState right_;
  Steering steering_;       ///< of a car
  TrackCommand on_ground_;  ///< [m/s] mean speeds of the tracks in the last integration step
  PlaneMotion body_;
  TermMemory memory_;  ///< of unnamed terms
  TermInputs inputs_;
  PlaneMotion led_to_;  ///< given by the tracks at the end of the last step, for the body's inertia
  TrackCommand acting_;
  std::deque<Waiting> waiting_;
  double time_ = 0.0;
};

/// Poses after each command relative to the start (the trajectory R of a pattern); each command is
/// held for `period` [s].
std::vector<Pose2> simulate(const VehicleModel& model, const std::vector<TrackCommand>& commands,
                            double period, const EntryState& entry,
                            const ExecutionNoise& noise = {});

/// Covariance of the last pose of a series of commands from the model's execution spread.
/** First order: J diag(spread^2) J^T with J by central differences over one standard deviation.
 * Does not include a change of ground. */
PoseCovariance endCovariance(const VehicleModel& model, const std::vector<TrackCommand>& commands,
                             double period, const EntryState& entry);

/// The same for a vehicle of any kind, starting in the steady motion of a command.
std::vector<Pose2> simulateFrom(const VehicleModel& model, const Command& entry,
                                const std::vector<Command>& commands, double period,
                                const ExecutionNoise& noise = {});

/// The motion class that a steady command maintains, with the model's twist.
MotionClass classOf(const VehicleModel& model, const std::string& name, const Command& steady);

/// Predicts trajectory and end covariance of a pattern that was never driven, entered in a steady
/// motion.
void predict(const VehicleModel& model, double period, const MotionClass& entry,
             MotionPattern& pattern);

/// Pose and yaw rate at one instant, true or measured by the INS.
struct MotionSample : PoseSample {
  double omega = 0.0;  ///< [rad/s]
};

/// The pose at an instant between samples, along the arc that joins its neighbours.
/** Extrapolated by the nearest arc before the first and after the last sample. `motion` is in order
 * of time, not empty, with less than a full turn between samples. */
Pose2 poseAt(const std::vector<MotionSample>& motion, double time);

/// The yaw rate at an instant, linear between samples, constant before the first and after the
/// last.
double yawRateAt(const std::vector<MotionSample>& motion, double time);

/// Parameters of all measurement effects: how the INS distorts the true motion.
/** Units and bounds are in the catalogue; 0 = off. A new one needs a value here, a line of
 * measuredPose() or measured() and an entry in the catalogue. */
struct MeasurementModel {
  double ins_latency = 0.0;           ///< [s]
  double ins_latency_gyro = 0.0;      ///< [1], shape: share of it that also affects the yaw rate
  double heading_latency = 0.0;       ///< [s], delay of the heading relative to the position
  double position_scale = 0.0;        ///< [1]
  double lever_arm_x = 0.0;           ///< [m]
  double lever_arm_y = 0.0;           ///< [m]
  double heading_misalignment = 0.0;  ///< [rad]
  double gyro_bias = 0.0;             ///< [rad/s]
  double gyro_bias_heading = 0.0;     ///< [1], shape: share of the bias that the heading integrates
};

/// Whether the INS measures the motion exactly: every measurement effect is off.
bool isPerfect(const MeasurementModel& measurement);

/// The pose measured at `time`; `pose` is the true one ins_latency earlier.
inline Pose2 measuredPose(const std::vector<MotionSample>& motion, const MeasurementModel& ins,
                          double time, Pose2 pose) {
  if (ins.lever_arm_x != 0.0 || ins.lever_arm_y != 0.0) {
    const Eigen::Vector2d p = pose * Eigen::Vector2d(-ins.lever_arm_x, -ins.lever_arm_y);
    pose.x = p.x();
    pose.y = p.y();
  }
  pose.x *= 1.0 + ins.position_scale;
  pose.y *= 1.0 + ins.position_scale;
  if (ins.heading_latency != 0.0)
    pose.yaw = poseAt(motion, time - ins.ins_latency - ins.heading_latency).yaw;
  pose.yaw -= ins.heading_misalignment;
  pose.yaw += ins.gyro_bias_heading * ins.gyro_bias * time;
  return pose;
}

/// The INS's measurement at the time of a sample of a true motion.
/** With t' = t - ins_latency: the position is (1 + position_scale) (p(t') - R(yaw(t')) lever_arm),
 * the heading yaw(t' - heading_latency) - heading_misalignment + gyro_bias_heading gyro_bias t, the
 * yaw rate omega(t - ins_latency_gyro ins_latency) + gyro_bias. Everything 0 returns the motion bit
 * for bit. */
inline MotionSample measured(const std::vector<MotionSample>& motion, const MeasurementModel& ins,
                             const MotionSample& now) {
  MotionSample said = now;
  if (ins.ins_latency != 0.0) said.T_map_body = poseAt(motion, now.time - ins.ins_latency);
  said.T_map_body = measuredPose(motion, ins, now.time, said.T_map_body);
  const double gyro_latency = ins.ins_latency_gyro * ins.ins_latency;
  if (gyro_latency != 0.0) said.omega = yawRateAt(motion, now.time - gyro_latency);
  said.omega += ins.gyro_bias;
  return said;
}

/// The same at all samples.
std::vector<MotionSample> measure(const std::vector<MotionSample>& motion,
                                  const MeasurementModel& measurement);

/// The INS's measurement at one instant: a yaw rate in addition to the pose of measure().
MotionSample measuredAt(const std::vector<MotionSample>& motion,
                        const MeasurementModel& measurement, double time);

}  // namespace tread
