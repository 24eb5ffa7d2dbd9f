// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/missions/true_patterns.hpp"

#include "tools/lab/missions/robot_system.hpp"

#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "modules/simulator/core/car.hpp"
#include "modules/simulator/core/noise.hpp"
#include "modules/simulator/core/speed_loop.hpp"

namespace tread::missions {
namespace {

constexpr double kStep = 1e-3;      // of the simulator [s]
constexpr int kStepsPerNoise = 10;  // simulator steps between disturbances: every 10 ms
constexpr double kEntry = 3.0;      // [s] until a motion is steady
/// From the bridge's stamp until the power changes: half a step of the bridge, the line, the
/// controller.
constexpr double kCommandDelay = 0.010;  // [s]
constexpr int kDisturbed = 60;           // executions per covariance

/// Motor input for a command: the power, or the output of the speed loops.
class DriveInput {
 public:
  DriveInput(const sim::VehicleParameters& vehicle, CommandKind kind, size_t motors)
      : holds_speeds_(kind == CommandKind::kTrackSpeed),
        steering_(vehicle.wheelbase > 0.0 ? vehicle.max_steering : 1.0),
        loops_(motors, sim::SpeedLoop(vehicle.drive.free_speed)) {}

  sim::MotorPower power(const Command& command, const sim::Plant& vehicle) {
    sim::MotorValues power{command[0], command[1] / steering_};
    for (size_t k = 2; k < loops_.size(); ++k) power[k] = command[k];
    // A speed controller works like the simulated one without its own loop.
    for (size_t k = 0; k < loops_.size() && holds_speeds_; ++k)
      power[k] = loops_[k].step(command[k], vehicle.motor(k).speed, kStep);
    return sim::MotorPower::of(power);
  }

 private:
  bool holds_speeds_;
  double steering_;
  std::vector<sim::SpeedLoop> loops_;
};

/// Body velocity at each step of an execution, without disturbances.
std::vector<Twist2> velocitiesOf(const MotionPattern& pattern, const Command& entry,
                                 const PatternSet& set, const sim::VehicleParameters& parameters,
                                 const sim::SurfaceParameters& surface) {
  const std::unique_ptr<sim::Plant> vehicle = sim::makeVehicle(parameters);
  DriveInput drive(parameters, set.content().channels.front().kind, vehicle->motors());
  const sim::Ground ground = sim::levelGround(surface);
  const auto run = [&](const Command& command, double seconds, std::vector<Twist2>* kept) {
    for (int i = 0; i < static_cast<int>(std::lround(seconds / kStep)); ++i) {
      vehicle->step(drive.power(command, *vehicle), ground, kStep);
      if (kept != nullptr) kept->push_back(vehicle->velocity());
    }
  };
  std::vector<Twist2> velocities;
  run(entry, kEntry, nullptr);
  run(entry, kCommandDelay, &velocities);
  for (const Command& command : pattern.commands) run(command, set.periodSeconds(), &velocities);
  velocities.resize(velocities.size() - static_cast<size_t>(std::lround(kCommandDelay / kStep)));
  return velocities;
}

Pose2 endOf(const std::vector<Twist2>& velocities, const sim::SurfaceParameters& surface,
            sim::MotionNoise& noise) {
  Pose2 pose;
  int steps = 0;
  for (const Twist2& v_body : velocities) {
    if (steps++ % kStepsPerNoise == 0) noise.step();
    pose = pose * integrate(noise.disturb(v_body, surface.spread), kStep);
  }
  return pose;
}

/// Covariance of the ends of disturbed executions, in the frame of the start.
PoseCovariance covarianceOf(const std::vector<Twist2>& velocities,
                            const sim::SurfaceParameters& surface) {
  sim::MotionNoise noise(1, kStep * kStepsPerNoise);
  std::vector<Pose2> ends;
  Pose2 mean;
  for (int i = 0; i < kDisturbed; ++i) {
    ends.push_back(endOf(velocities, surface, noise));
    mean.x += ends.back().x / kDisturbed;
    mean.y += ends.back().y / kDisturbed;
    mean.yaw += ends.back().yaw / kDisturbed;
  }
  PoseCovariance covariance{};
  for (const Pose2& end : ends) {
    const double x = end.x - mean.x, y = end.y - mean.y, yaw = end.yaw - mean.yaw;
    const double products[] = {x * x, x * y, x * yaw, y * y, y * yaw, yaw * yaw};
    for (size_t i = 0; i < covariance.size(); ++i) covariance[i] += products[i] / (kDisturbed - 1);
  }
  return covariance;
}

void makeTrue(MotionPattern& pattern, const PatternSet& shipped,
              const sim::VehicleParameters& vehicle, const sim::SurfaceParameters& surface) {
  const Command& entry = shipped.classNamed(pattern.entry_class).steady;
  const std::vector<Twist2> velocities = velocitiesOf(pattern, entry, shipped, vehicle, surface);
  const size_t per_sample = velocities.size() / pattern.commands.size();
  Pose2 pose;
  for (size_t i = 0; i < velocities.size(); ++i) {
    pose = pose * integrate(velocities[i], kStep);
    if ((i + 1) % per_sample == 0) pattern.trajectory[i / per_sample] = pose;
  }
  pattern.end_covariance = covarianceOf(velocities, surface);
}

PatternSetContent trueSet(const PatternSet& shipped, const sim::VehicleParameters& vehicle,
                          const sim::SurfaceParameters& surface) {
  PatternSetContent content = shipped.content();
  for (MotionClass& motion : content.classes) {
    MotionPattern held;
    held.commands.assign(1, motion.steady);
    motion.twist = velocitiesOf(held, motion.steady, shipped, vehicle, surface).back();
  }
  for (MotionPattern& pattern : content.patterns) makeTrue(pattern, shipped, vehicle, surface);
  return content;
}

PatternSet checked(PatternSetContent content, const std::string& surface) {
  std::string why;
  std::optional<PatternSet> set = PatternSet::make(std::move(content), why);
  if (!set) throw std::logic_error("true patterns on " + surface + ": " + why);
  return *set;
}

}  // namespace

TruePatterns::TruePatterns(const PatternSet& shipped, const sim::VehicleParameters& vehicle,
                           const std::vector<sim::SurfaceParameters>& more) {
  for (const auto* surfaces : {&sim::builtInSurfaces(), &more})
    for (const sim::SurfaceParameters& surface : *surfaces)
      by_surface_.insert_or_assign(surface.name, trueSet(shipped, vehicle, surface));
}

PatternSet TruePatterns::on(const std::string& surface, int64_t version) const {
  PatternSetContent content = by_surface_.at(surface);
  content.parent_version = version - 1;
  content.version = version;
  return checked(std::move(content), surface);
}

PatternSet TruePatterns::mixedInto(const PatternSet& learned, const std::string& surface,
                                   TrueShare share) const {
  const PatternSetContent& truth = by_surface_.at(surface);
  PatternSetContent content = learned.content();
  if (share != TrueShare::kCovariances) content.classes = truth.classes;
  for (size_t i = 0; i < content.patterns.size(); ++i) {
    if (share != TrueShare::kCovariances)
      content.patterns[i].trajectory = truth.patterns[i].trajectory;
    if (share != TrueShare::kMeans)
      content.patterns[i].end_covariance = truth.patterns[i].end_covariance;
  }
  return checked(std::move(content), surface);
}

void TruePatternsNode::step(int64_t utime) {
  const std::string& present = robot_.truth().surface;
  const bool changed = present != surface_;
  if (changed) ++version_;
  surface_ = present;
  if (changed || (utime >= next_repeat_ && publisher_.setsSent())) {
    publisher_.putSet(patterns_.on(surface_, version_));
    next_repeat_ = utime + kRepeat;
  }
  publisher_.step(utime);
}

}  // namespace tread::missions
