// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/kernel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <Eigen/Core>

#include "common/vehicle/effects.hpp"
#include "common/vehicle/omni_kernel.hpp"

namespace tread {

using namespace steps;

namespace {

constexpr double kShortestStep = 1e-12;  // [s], less is rounding of time

double supplied(const VehicleModel& model, const DriveContext& context, double asked) {
  return suppliedSpeed(model.effects, asked, context.session_time, context.battery_drop);
}

/// Speeds asked of the drives for what is supplied to them, before added effects.
TrackCommand driveTargets(const VehicleModel& model, const TrackCommand& supply,
                          const TrackCommand& heat) {
  return {driveTarget(model.effects, supply.left, 1.0, heat.left),
          driveTarget(model.effects, supply.right, -1.0, heat.right)};
}

TrackCommand supplied(const VehicleModel& model, const DriveContext& context,
                      const TrackCommand& asked) {
  return {supplied(model, context, asked.left), supplied(model, context, asked.right)};
}

/// After long motion in one direction a track's slack is taken up.
TrackState enteredTrack(const EffectValues& effects, double speed, double ramp, double heat) {
  return {speed, ramp, speed < 0.0 ? effects.track_backlash : 0.0, heat};
}

using EndUnder = std::function<Pose2(const ExecutionNoise&)>;

/// Change of the end pose per standard deviation of one noise component.
Eigen::Vector3d sensitivity(const EndUnder& end, const ExecutionNoise& low,
                            const ExecutionNoise& high) {
  const Pose2 from = end(low);
  const Pose2 to = end(high);
  return Eigen::Vector3d(to.x - from.x, to.y - from.y, to.yaw - from.yaw) / 2.0;
}

PoseCovariance endCovariance(const ExecutionSpread& spread, const EndUnder& end) {
  const std::array<ExecutionNoise, 3> low{ExecutionNoise{1.0 - spread.forward, 1.0, 0.0},
                                          ExecutionNoise{1.0, 1.0 - spread.yaw, 0.0},
                                          ExecutionNoise{1.0, 1.0, -spread.crab}};
  const std::array<ExecutionNoise, 3> high{ExecutionNoise{1.0 + spread.forward, 1.0, 0.0},
                                           ExecutionNoise{1.0, 1.0 + spread.yaw, 0.0},
                                           ExecutionNoise{1.0, 1.0, spread.crab}};
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (size_t i = 0; i < low.size(); ++i) {
    const Eigen::Vector3d change = sensitivity(end, low[i], high[i]);
    covariance += change * change.transpose();
  }
  return {covariance(0, 0), covariance(0, 1), covariance(0, 2),
          covariance(1, 1), covariance(1, 2), covariance(2, 2)};
}

}  // namespace

EntryState steadyEntry(const VehicleModel& model, const TrackCommand& command,
                       const DriveContext& context) {
  const TrackCommand asked = model.trackSpeeds(command);
  EntryState entry;
  entry.track_speeds = driveTargets(model, supplied(model, context, asked), {});
  AddedEffects added(model.effects);
  if (added.changeTracks()) {
    added.settleTracks(entry.track_speeds, model.gauge, context);
    entry.track_speeds = added.tracks(entry.track_speeds, model.gauge, context, 0.0);
  }
  entry.command = command;
  entry.context = context;
  return entry;
}

Twist2 steadyTwist(const VehicleModel& model, const TrackCommand& command,
                   const DriveContext& context) {
  return VehicleKernel(model, steadyEntry(model, command, context)).twist();
}

VehicleKernel::VehicleKernel(const VehicleModel& model, const EntryState& entry,
                             const ExecutionNoise& noise)
    : model_(model),
      added_(model.effects),
      context_(entry.context),
      left_(enteredTrack(model.effects, entry.track_speeds.left,
                         entry.ramps.value_or(entry.track_speeds).left, entry.heat.left)),
      right_(enteredTrack(model.effects, entry.track_speeds.right,
                          entry.ramps.value_or(entry.track_speeds).right, entry.heat.right)),
      steering_(entry.steering.value_or(
          Steering{entry.command.right, entry.command.right, entry.command.right})),
      on_ground_(model.onGround(entry.track_speeds, wheelAngle(model, steering_.linkage))),
      acting_(entry.command) {
  setNoise(noise);
  const ChangesInForce changes = changesAt(model_.effects, context_.session_time, 0.0);
  led_to_ = groundMotion(model_, noise_, changes, on_ground_);
  body_ = entry.body ? *entry.body : led_to_;
  memory_ = entry.memory.value_or(TermMemory{body_.v, body_.omega, 0.0});
  if (added_.changeTracks())
    added_.settleTracks(
        driveTargets(model_, supplied(model_, context_, model_.trackSpeeds(acting_)), entry.heat),
        model_.gauge, context_);
  if (added_.changeMotion())
    added_.settleMotion(known(withCommand(inputsNow(body_.v, body_.omega, memory_)), on_ground_),
                        {body_.v, 0.0, body_.omega});
  added_.remember(entry.added_memory);
}

void VehicleKernel::setNoise(const ExecutionNoise& noise) {
  noise_ = noise;
  tan_crab_ = std::tan(noise.crab + model_.effects.crab);
}

void VehicleKernel::give(const TrackCommand& command) {
  waiting_.push_back({time_ + model_.commandDelay(), command});
}

void VehicleKernel::hold(double duration) {
  const double end = time_ + duration;
  while (!waiting_.empty() && waiting_.front().until < end - kShortestStep) {
    advance(waiting_.front().until - time_);
    acting_ = waiting_.front().command;
    waiting_.pop_front();
  }
  advance(end - time_);
  time_ = end;
}

void VehicleKernel::hold(double duration, const DriveContext& context) {
  context_ = context;
  hold(duration);
}

void VehicleKernel::step(const TrackCommand& command, double duration) {
  give(command);
  hold(duration);
}

void VehicleKernel::step(const TrackCommand& command, double duration,
                         const DriveContext& context) {
  give(command);
  hold(duration, context);
}

void VehicleKernel::advance(double duration) {
  if (duration < kShortestStep) return;
  const TrackCommand asked = model_.trackSpeeds(acting_);
  const int steps = std::max(1, static_cast<int>(std::ceil(duration / model_.step - 1e-6)));
  const double dt = duration / steps;
  for (int i = 0; i < steps; ++i) integrateStep(asked, dt);
  time_ += duration;
}

void VehicleKernel::integrateStep(const TrackCommand& asked, double dt) {
  const EffectValues& effects = model_.effects;
  const TrackCommand supply = supplied(model_, context_, asked);
  TrackCommand targets = driveTargets(model_, supply, {left_.heat, right_.heat});
  if (added_.changeTracks()) targets = added_.tracks(targets, model_.gauge, context_, dt);
  const TrackCommand driven{driveTrack(model_, supply.left, targets.left, dt, left_),
                            driveTrack(model_, supply.right, targets.right, dt, right_)};
  on_ground_ = model_.onGround(driven, steer(dt));
  const ChangesInForce changes = changesAt(effects, context_.session_time, dt);
  const PlaneMotion steady = groundMotion(model_, noise_, changes, on_ground_);
  const PlaneMotion motion = moveBody(changes, steady, dt);
  Twist2 v_body;
  if (!addsToMotion()) {
    v_body = bodyTwist(effects, tan_crab_, changes, context_, on_ground_, motion);
  } else {
    inputs_ = withCommand(remember(motion.v, motion.omega, dt, memory_));
    v_body = withTerms(inputs_, changes, on_ground_, motion,
                       addedTo(motion, inputs_, changes, on_ground_, dt, added_));
  }
  T_start_body_ = T_start_body_ * integrate(v_body, dt);
  context_.session_time += dt;
}

TermInputs VehicleKernel::withCommand(TermInputs inputs) const {
  const TrackCommand asked = model_.trackSpeeds(acting_);
  inputs.forward = 0.5 * (asked.left + asked.right);
  inputs.turning = 0.5 * (asked.right - asked.left);
  return inputs;
}

LawInputs VehicleKernel::known(const TermInputs& inputs, const TrackCommand& tracks) const {
  return {inputs, tracks, context_, model_.gauge, movingShare(model_, tracks, inputs)};
}

Twist2 VehicleKernel::addedTo(const PlaneMotion& motion, const TermInputs& inputs,
                              const ChangesInForce& changes, const TrackCommand& tracks, double dt,
                              AddedEffects& added) const {
  if (!added.changeMotion()) return {};
  const Twist2 plain = bodyTwist(model_.effects, tan_crab_, changes, context_, tracks, motion);
  return added.changes(known(inputs, tracks), {motion.v, plain.v_y, motion.omega}, dt);
}

Twist2 VehicleKernel::withTerms(const TermInputs& inputs, const ChangesInForce& changes,
                                const TrackCommand& tracks, PlaneMotion motion,
                                const Twist2& added) const {
  const Twist2 more = unnamedTwist(model_, movingShare(model_, tracks, inputs), inputs);
  motion.v += more.v_x + added.v_x;
  motion.omega += more.omega + added.omega;
  Twist2 v_body = bodyTwist(model_.effects, tan_crab_, changes, context_, tracks, motion);
  v_body.v_y += more.v_y + added.v_y;
  return v_body;
}

double VehicleKernel::steer(double dt) {
  return model_.isCar() ? steps::steer(model_, acting_.right, dt, steering_) : 0.0;
}

PlaneMotion VehicleKernel::moveBody(const ChangesInForce& changes, const PlaneMotion& mean,
                                    double dt) {
  const EffectValues& effects = model_.effects;
  if (effects.body_inertia <= 0.0 && effects.yaw_inertia <= 0.0) {
    body_ = mean;
    return mean;
  }
  // Tracks with a lag below the step jump to their final value; of slack only means are known.
  const bool gradual = model_.driveLag() >= dt && effects.track_backlash == 0.0;
  const PlaneMotion begin = gradual ? led_to_ : mean;
  const PlaneMotion end =
      gradual ? groundMotion(model_, noise_, changes,
                             model_.onGround(trackSpeeds(), wheelAngle(model_, steering_.linkage)))
              : mean;
  const Followed v = follow(body_.v, {begin.v, mean.v, end.v}, effects.body_inertia, dt);
  const Followed omega =
      follow(body_.omega, {begin.omega, mean.omega, end.omega}, effects.yaw_inertia, dt);
  led_to_ = end;
  body_ = {v.end, omega.end};
  return {v.mean, omega.mean};
}

Twist2 VehicleKernel::twist() const {
  const EffectValues& effects = model_.effects;
  const ChangesInForce changes = changesAt(effects, context_.session_time, 0.0);
  const TrackCommand tracks =
      effects.track_backlash == 0.0
          ? model_.onGround(trackSpeeds(), wheelAngle(model_, steering_.linkage))
          : on_ground_;
  PlaneMotion motion = groundMotion(model_, noise_, changes, tracks);
  if (effects.body_inertia > 0.0) motion.v = body_.v;
  if (effects.yaw_inertia > 0.0) motion.omega = body_.omega;
  if (!addsToMotion()) return bodyTwist(effects, tan_crab_, changes, context_, tracks, motion);
  const TermInputs inputs = withCommand(inputsNow(motion.v, motion.omega, memory_));
  AddedEffects added = added_;
  return withTerms(inputs, changes, tracks, motion,
                   addedTo(motion, inputs, changes, tracks, 0.0, added));
}

EntryState VehicleKernel::state() const {
  EntryState state;
  state.track_speeds = trackSpeeds();
  state.command = acting_;
  state.context = context_;
  state.body = body_;
  state.heat = {left_.heat, right_.heat};
  state.ramps = {left_.ramp, right_.ramp};
  state.steering = steering_;
  state.memory = memory_;
  state.added_memory = added_.memory();
  return state;
}

std::vector<Pose2> simulate(const VehicleModel& model, const std::vector<TrackCommand>& commands,
                            double period, const EntryState& entry, const ExecutionNoise& noise) {
  VehicleKernel kernel(model, entry, noise);
  std::vector<Pose2> poses;
  poses.reserve(commands.size());
  for (const TrackCommand& command : commands) {
    kernel.step(command, period);
    poses.push_back(kernel.pose());
  }
  return poses;
}

PoseCovariance endCovariance(const VehicleModel& model, const std::vector<TrackCommand>& commands,
                             double period, const EntryState& entry) {
  if (commands.empty()) return kUnknownCovariance;
  return endCovariance(model.spread, [&](const ExecutionNoise& noise) {
    return simulate(model, commands, period, entry, noise).back();
  });
}

std::vector<Pose2> simulateFrom(const VehicleModel& model, const Command& entry,
                                const std::vector<Command>& commands, double period,
                                const ExecutionNoise& noise) {
  if (!model.isOmni())
    return simulate(model, tracksOf(commands), period, steadyEntry(model, entry.tracks()), noise);
  OmniKernel kernel(model, entry, noise);
  std::vector<Pose2> poses;
  poses.reserve(commands.size());
  for (const Command& command : commands) {
    kernel.step(command, period);
    poses.push_back(kernel.pose());
  }
  return poses;
}

MotionClass classOf(const VehicleModel& model, const std::string& name, const Command& steady) {
  const Twist2 twist =
      model.isOmni() ? OmniKernel(model, steady).twist() : steadyTwist(model, steady.tracks());
  return {name, twist, steady};
}

void predict(const VehicleModel& model, double period, const MotionClass& entry,
             MotionPattern& pattern) {
  const auto simulated = [&](const ExecutionNoise& noise) {
    return simulateFrom(model, entry.steady, pattern.commands, period, noise);
  };
  pattern.trajectory = simulated({});
  pattern.end_covariance = pattern.commands.empty()
                               ? kUnknownCovariance
                               : endCovariance(model.spread, [&](const ExecutionNoise& noise) {
                                   return simulated(noise).back();
                                 });
}

namespace {

/// Index of the sample with which the interval around `time` begins.
size_t intervalAt(const std::vector<MotionSample>& motion, double time) {
  const auto later =
      std::upper_bound(motion.begin(), motion.end(), time,
                       [](double moment, const MotionSample& pose) { return moment < pose.time; });
  const auto index = static_cast<size_t>(std::distance(motion.begin(), later));
  return std::min(std::max<size_t>(index, 1) - 1, motion.size() - 2);
}

}  // namespace

Pose2 poseAt(const std::vector<MotionSample>& motion, double time) {
  if (motion.size() < 2) return motion.front().T_map_body;
  const size_t i = intervalAt(motion, time);
  const MotionSample& from = motion[i];
  const MotionSample& to = motion[i + 1];
  if (time == from.time || to.time <= from.time) return from.T_map_body;
  if (time == to.time) return to.T_map_body;
  const Twist2 v_body = twistTo(between(from.T_map_body, to.T_map_body), to.time - from.time);
  return from.T_map_body * integrate(v_body, time - from.time);
}

double yawRateAt(const std::vector<MotionSample>& motion, double time) {
  if (motion.size() < 2 || time <= motion.front().time) return motion.front().omega;
  if (time >= motion.back().time) return motion.back().omega;
  const size_t i = intervalAt(motion, time);
  const double span = motion[i + 1].time - motion[i].time;
  if (span <= 0.0) return motion[i].omega;
  const double share = (time - motion[i].time) / span;
  return motion[i].omega + share * (motion[i + 1].omega - motion[i].omega);
}

bool isPerfect(const MeasurementModel& measurement) {
  const std::deque<Effect>& effects = effectCatalogue();
  return std::none_of(effects.begin(), effects.end(), [&](const Effect& effect) {
    return effect.kind() == EffectKind::kMeasurement && isOn(effect, {}, measurement);
  });
}

std::vector<MotionSample> measure(const std::vector<MotionSample>& motion,
                                  const MeasurementModel& measurement) {
  std::vector<MotionSample> said;
  said.reserve(motion.size());
  for (const MotionSample& now : motion) said.push_back(measured(motion, measurement, now));
  return said;
}

MotionSample measuredAt(const std::vector<MotionSample>& motion,
                        const MeasurementModel& measurement, double time) {
  return measured(motion, measurement, {time, poseAt(motion, time), yawRateAt(motion, time)});
}

}  // namespace tread
