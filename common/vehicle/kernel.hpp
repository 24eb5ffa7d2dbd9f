// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/pattern/pattern.hpp"
#include "common/vehicle/added_effects.hpp"
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
  /// [m/s] that the drives are asked for by their ramps, see slew_limit; else their speeds.
  std::optional<TrackCommand> ramps = std::nullopt;
  std::optional<Steering> steering = std::nullopt;  ///< of a car; else that of the command
  /// Of unnamed terms; else as after a long time in the motion at the start, turns forgotten.
  std::optional<TermMemory> memory = std::nullopt;
  AddedMemory added_memory{};  ///< of added effects of the same model; else as after a long time
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
  /// Gives a command; it acts from the model's delay on until the next one does.
  void give(const TrackCommand& command);
  /// Goes on for `duration` [s] with what was given, as the last step(): one that holds a command
  /// through many short times is integrated over each of them at once, whatever the delay.
  void hold(double duration, const DriveContext& context);

  /// The body stands at once, as at a hard obstacle; tracks and waiting commands go on.
  void stopBody() { body_ = {}; }

  /// Pose relative to the start, yaw unwrapped.
  const Pose2& pose() const { return T_start_body_; }
  /// Body twist at this moment.
  Twist2 twist() const;
  /// Speeds of the drive, before slack and slip [m/s].
  TrackCommand trackSpeeds() const { return {left_.speed, right_.speed}; }
  /// What unnamed terms depended on in the last step; nothing is kept of a model with neither terms
  /// nor added effects of the motion.
  const TermInputs& termInputs() const { return inputs_; }
  /// State from which another kernel can begin (without waiting commands and slack).
  EntryState state() const;
  /// Changes the noise from now on, for noise that varies along a drive.
  void setNoise(const ExecutionNoise& noise);

 private:
  struct Waiting {
    double until;  ///< [s] since the start; it begins to act then
    TrackCommand command;
  };

  void hold(double duration);
  void advance(double duration);
  void integrateStep(const TrackCommand& asked, double dt);
  /// Moves a car's steering on by dt; returns the mean angle of its wheels meanwhile [rad].
  double steer(double dt);
  /// Forward speed and yaw rate of a body that follows the tracks over dt; its mean meanwhile.
  PlaneMotion moveBody(const ChangesInForce& changes, const PlaneMotion& mean, double dt);
  /// The same inputs with what the command asks for.
  TermInputs withCommand(TermInputs inputs) const;
  /// What added effects add to a motion; their memories move on by dt.
  Twist2 addedTo(const PlaneMotion& motion, const TermInputs& inputs, const ChangesInForce& changes,
                 const TrackCommand& tracks, double dt, AddedEffects& added) const;
  /// The body twist of a motion to which that and unnamed terms are added.
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
  TrackCommand on_ground_;  ///< [m/s] mean speeds of the tracks in the last step of integration
  PlaneMotion body_;
  TermMemory memory_;  ///< of unnamed terms
  TermInputs inputs_;
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

/// The same for a vehicle of any kind, entered in the steady motion of a command.
std::vector<Pose2> simulateFrom(const VehicleModel& model, const Command& entry,
                                const std::vector<Command>& commands, double period,
                                const ExecutionNoise& noise = {});

/// The motion class that a steady command keeps up, with the model's twist.
MotionClass classOf(const VehicleModel& model, const std::string& name, const Command& steady);

/// Fills trajectory and end covariance of a pattern that was never driven, entered in a steady
/// motion.
void predict(const VehicleModel& model, double period, const MotionClass& entry,
             MotionPattern& pattern);

/// Pose and yaw rate at one moment, of the vehicle or as the INS says.
struct MotionSample {
  double time = 0.0;   ///< [s] since the start of the session
  Pose2 T_map_body;    ///< yaw unwrapped
  double omega = 0.0;  ///< [rad/s]
};

/// The pose at a moment between samples, along the arc that joins its neighbours.
/** Before the first and after the last sample the nearest arc goes on. `motion` in the order of
 * time, not empty, less than a full turn between samples. */
Pose2 poseAt(const std::vector<MotionSample>& motion, double time);

/// The yaw rate at a moment, linear between samples, constant before the first and after the last.
double yawRateAt(const std::vector<MotionSample>& motion, double time);

/// Values of the parameters of all measurement effects: what the INS makes of the true motion.
/** Units and bounds stand in the catalogue; 0 = off. A new one is a value here, a line of
 * measuredPose() or measured() and its entry in the catalogue. */
struct MeasurementModel {
  double ins_latency = 0.0;           ///< [s]
  double ins_latency_gyro = 0.0;      ///< [1], shape: share of it that the yaw rate has, too
  double heading_latency = 0.0;       ///< [s], of the heading behind the position
  double position_scale = 0.0;        ///< [1]
  double lever_arm_x = 0.0;           ///< [m]
  double lever_arm_y = 0.0;           ///< [m]
  double heading_misalignment = 0.0;  ///< [rad]
  double gyro_bias = 0.0;             ///< [rad/s]
  double gyro_bias_heading = 0.0;     ///< [1], shape: share of it that the heading integrates
};

/// Whether the INS says the motion as it is: every measurement effect is off.
bool isPerfect(const MeasurementModel& measurement);

/// What the INS says of the pose at `time`, `pose` being the true one of ins_latency ago.
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

/// What the INS says at the moment of a sample of a true motion.
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

/// The same at all its moments.
std::vector<MotionSample> measure(const std::vector<MotionSample>& motion,
                                  const MeasurementModel& measurement);

/// What the INS says at one moment: a yaw rate beside the pose as in measure().
MotionSample measuredAt(const std::vector<MotionSample>& motion,
                        const MeasurementModel& measurement, double time);

}  // namespace tread
