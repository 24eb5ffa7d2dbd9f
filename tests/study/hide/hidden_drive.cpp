// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/hide/hidden_drive.hpp"

#include <algorithm>
#include <cmath>

#include "modules/simulator/core/instruments.hpp"
#include "modules/simulator/core/noise.hpp"

namespace tread::blind {
namespace {

constexpr double kDt = 1e-3;  // [s]
constexpr int64_t kStepUs = 1000;
constexpr int64_t kSlowSteps = Track::kStepUs / kStepUs;

/// The ground's random factor on a pattern's speed and yaw rate: half of the variance is new for
/// each pattern, half is correlated with the previous one.
class GroundNoise {
 public:
  GroundNoise(uint64_t seed, double spread)
      : gaussian_(seed),
        share_(spread * std::sqrt(0.5)),
        speed_(gaussian_.draw()),
        yaw_(gaussian_.draw()) {}

  void nextPattern() {
    constexpr double kMemory = 0.7;
    const double fresh = std::sqrt(1.0 - kMemory * kMemory);
    speed_ = kMemory * speed_ + fresh * gaussian_.draw();
    yaw_ = kMemory * yaw_ + fresh * gaussian_.draw();
    speed_gain_ = 1.0 + share_ * (speed_ + gaussian_.draw());
    yaw_gain_ = 1.0 + share_ * (yaw_ + gaussian_.draw());
  }

  Twist2 disturb(const Twist2& v) const {
    return {v.v_x * speed_gain_, v.v_y * speed_gain_, v.omega * yaw_gain_};
  }

 private:
  sim::Gaussian gaussian_;
  double share_;
  double speed_;
  double yaw_;
  double speed_gain_ = 1.0;
  double yaw_gain_ = 1.0;
};

void move(Pose2& pose, const Twist2& v) {
  const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
  pose.x += kDt * (c * v.v_x - s * v.v_y);
  pose.y += kDt * (s * v.v_x + c * v.v_y);
  pose.yaw += kDt * v.omega;
}

/// The vehicle with everything hidden in it.
class Machine {
 public:
  explicit Machine(std::vector<Hidden> hidden)
      : hidden_(std::move(hidden)), build_(buildAt(0.0)), vehicle_(build_.vehicle) {
    vehicle_.setCharge(1.0);
  }

  /// One step of 1 ms; the body's velocity afterwards.
  Twist2 step(Moment& now, const sim::MotorPower& order) {
    rebuildIfDue(now.time);
    sense(now, order);
    sim::MotorPower power = order;
    sim::OutsideForce force = bearing();
    for (Hidden& one : hidden_) {
      if (one.hider.drive) power = one.hider.drive(now, power);
      if (one.hider.touch) one.hider.touch(now, vehicle_);
      if (!one.hider.push) continue;
      const sim::OutsideForce more = one.hider.push(now);
      force = {force.along + more.along, force.across + more.across, force.moment + more.moment};
    }
    vehicle_.setOutsideForce(force);
    vehicle_.step(power, sim::levelGround(build_.surface), kDt);
    Twist2 v = vehicle_.velocity();
    for (Hidden& one : hidden_)
      if (one.hider.slide) v = one.hider.slide(now, v);
    return v;
  }

  MotorSample motor() const {
    return {vehicle_.battery().voltage, vehicle_.left().current, vehicle_.right().current};
  }

 private:
  /// The plain vehicle has no such outward drift: it could be a hidden effect.
  sim::OutsideForce bearing() const {
    const Twist2 v = vehicle_.velocity();
    return {0.0, build_.vehicle.mass * v.v_x * v.omega, 0.0};
  }

  Build buildAt(double time) {
    Build build{plainVehicle(), plainSurface()};
    for (Hidden& one : hidden_)
      if (one.hider.build) one.hider.build(time, build);
    return build;
  }

  void rebuildIfDue(double time) {
    for (const Hidden& one : hidden_)
      for (const double due : one.hider.due)
        if (time >= due && due > built_at_) {
          built_at_ = time;
          build_ = buildAt(time);
          vehicle_.rebuild(build_.vehicle);
          return;
        }
  }

  void sense(Moment& now, const sim::MotorPower& order) const {
    now.order = order;
    now.v_body = vehicle_.velocity();
    now.belt_left = vehicle_.left().speed;
    now.belt_right = vehicle_.right().speed;
    now.current_left = vehicle_.left().current;
    now.current_right = vehicle_.right().current;
    now.voltage = vehicle_.battery().voltage;
  }

  std::vector<Hidden> hidden_;
  Build build_;
  sim::TrackedVehicle vehicle_;
  double built_at_ = 0.0;
};

void tilt(Moment& now, const sim::Terrain& terrain, const Pose2& pose) {
  const sim::BodyPose body = sim::poseOnGround(pose, 0.0, terrain.gradient(pose.position()));
  now.pitch = body.pitch;
  now.roll = body.roll;
}

}  // namespace

std::vector<Hidden> makeHidden(const std::vector<std::string>& effects, double size,
                               double duration, uint64_t seed) {
  std::vector<Hidden> hidden;
  for (const std::string& name : effects) {
    const EffectSpec& spec = effectNamed(name);
    Rng rng(sim::streamSeed(seed, kEffectStream));
    hidden.push_back({&spec, size, spec.make(size, duration, rng)});
  }
  std::stable_sort(hidden.begin(), hidden.end(),
                   [](const Hidden& a, const Hidden& b) { return a.hider.stage < b.hider.stage; });
  return hidden;
}

HiddenDrive drive(const Programme& programme, std::vector<Hidden> hidden, const NoiseLevel& noise,
                  uint64_t seed) {
  HiddenDrive result;
  result.programme = programme;
  const sim::Terrain terrain = rollingTerrain(sim::streamSeed(seed, kTerrainStream));
  GroundNoise ground(sim::streamSeed(seed, kGroundNoiseStream), noise.terrain);
  Machine machine(std::move(hidden));
  Track& track = result.track;
  Moment now;
  Pose2 pose, clean;
  Twist2 v, v_clean;
  sim::MotorPower order;
  int playing = -1;
  for (int64_t step = 0; step * kStepUs <= programme.duration; ++step) {
    const int64_t time = step * kStepUs;
    if (time % kCommandUs == 0) {
      const int pattern = programme.at(time);
      if (pattern >= 0 && pattern != playing) ground.nextPattern();
      playing = pattern;
      order =
          pattern < 0 ? sim::MotorPower{} : programme.patterns[static_cast<size_t>(pattern)].power;
      result.motor.push_back(machine.motor());
    }
    if (step % kSlowSteps == 0) {
      tilt(now, terrain, pose);
      track.T_map_body.push_back(pose);
      track.T_map_clean.push_back(clean);
      track.v_body.push_back(v);
      track.v_clean.push_back(v_clean);
      track.pitch.push_back(static_cast<float>(now.pitch));
      track.roll.push_back(static_cast<float>(now.roll));
      track.height.push_back(static_cast<float>(terrain.height(pose.position())));
    }
    now.time = static_cast<double>(time) * 1e-6;
    v_clean = machine.step(now, order);
    v = ground.disturb(v_clean);
    move(pose, v);
    move(clean, v_clean);
  }
  return result;
}

namespace {

/// Squared power, low-pass of 180 s, at the middle of each pattern.
std::vector<double> duties(const Programme& programme) {
  constexpr double kTime = 180.0;
  std::vector<double> all;
  double duty = 0.0;
  double time = 0.0;
  for (const Pattern& pattern : programme.patterns) {
    const double start = static_cast<double>(pattern.start) * 1e-6;
    duty *= std::exp(-(start - time) / kTime);
    const double square =
        0.5 * (pattern.power.left * pattern.power.left + pattern.power.right * pattern.power.right);
    const double half = std::exp(-0.5 * kPatternSeconds / kTime);
    duty = square + (duty - square) * half;
    all.push_back(duty);
    duty = square + (duty - square) * half;
    time = start + kPatternSeconds;
  }
  return all;
}

Twist2 meanTwist(const std::vector<Twist2>& twists, size_t from, size_t to) {
  Twist2 sum;
  for (size_t i = from; i < to; ++i)
    sum = {sum.v_x + twists[i].v_x, sum.v_y + twists[i].v_y, sum.omega + twists[i].omega};
  const auto count = static_cast<double>(to - from);
  return {sum.v_x / count, sum.v_y / count, sum.omega / count};
}

double meanAngle(const std::vector<float>& angles, size_t from, size_t to) {
  double sum = 0.0;
  for (size_t i = from; i < to; ++i) sum += static_cast<double>(angles[i]);
  return sum / static_cast<double>(to - from);
}

/// Track speed per power for equal commands of both tracks.
double speedPerPower(const std::vector<SteadyPair>& pairs) {
  double speed = 0.0, power = 0.0;
  for (const SteadyPair& pair : pairs) {
    if (pair.order.left != pair.order.right) continue;
    speed += pair.order.left * pair.without.v_x;
    power += pair.order.left * pair.order.left;
  }
  return power > 0.0 ? speed / power : 1.2;
}

}  // namespace

Comparison compare(const HiddenDrive& with, const HiddenDrive& without) {
  Comparison comparison;
  comparison.duration = static_cast<double>(with.programme.duration) * 1e-6;
  const std::vector<double> duty = duties(with.programme);
  for (size_t i = 0; i < with.programme.patterns.size(); ++i) {
    const Pattern& pattern = with.programme.patterns[i];
    constexpr int64_t kHalf = kCommandsPerPattern * kCommandUs / 2;
    const auto from = static_cast<size_t>((pattern.start + kHalf) / Track::kStepUs);
    const auto to = from + static_cast<size_t>(kHalf / Track::kStepUs);
    SteadyPair pair;
    pair.with = meanTwist(with.track.v_clean, from, to);
    pair.without = meanTwist(without.track.v_clean, from, to);
    pair.order = pattern.power;
    pair.time = static_cast<double>(pattern.start + kHalf) * 1e-6;
    pair.duty = duty[i];
    pair.pitch = meanAngle(with.track.pitch, from, to);
    pair.roll = meanAngle(with.track.roll, from, to);
    comparison.pairs.push_back(pair);
  }
  comparison.speed = speedPerPower(comparison.pairs);
  return comparison;
}

}  // namespace tread::blind
