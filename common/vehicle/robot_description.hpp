// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/fence/fence.hpp"
#include "common/geometry/se2.hpp"
#include "common/geometry/se3.hpp"
#include "common/pattern/pattern.hpp"
#include "common/vehicle/omni_wheels.hpp"

namespace tread {

class ConfigReader;

/// Running gear and its drive.
enum class DriveLayout {
  kTracks,            ///< two, a motor each
  kSkidSteer4,        ///< four wheels that are not steered, a motor each
  kThrottleSteering,  ///< a car: rear wheels driven together, front wheels steered
  kOmni  ///< three or more wheels with rollers, a motor each: it moves in all directions
};

/// What drives the tracks or wheels, and how it is wired.
struct DriveDescription {
  DriveLayout layout = DriveLayout::kTracks;
  CommandKind kind = CommandKind::kPower;  ///< of the tracks or the throttle
  /// [m/s] of a track, or of a wheel's rim, at full command; of a car straight ahead.
  double full_speed = 0.0;
  double max_command = 0.0;   ///< largest magnitude of a command: power [1] or track speed [m/s]
  int left_channel = 1;       ///< 1 or 2, of the motor controller; the right track uses the other
  bool invert_left = false;   ///< the left motor (of a car: the throttle) is mounted in reverse
  bool invert_right = false;  ///< a car's steering
  double wheelbase = 0.0;  ///< [m] of a car, between its axles; the body origin is on the rear one
  double max_steering = 0.0;        ///< [rad] of a car, to either side
  OmniWheels wheels;                ///< of a holonomic base; otherwise empty
  std::vector<bool> invert_wheels;  ///< whether each one's motor is mounted in reverse

  bool isCar() const { return layout == DriveLayout::kThrottleSteering; }
  bool isOmni() const { return layout == DriveLayout::kOmni; }
  /// [m/s] of the fastest point between the wheels: wheels that act together can move a base faster
  /// than their rims.
  double topSpeed() const { return isOmni() ? full_speed * wheels.reach() : full_speed; }
  /// Command for the controller's full output: power 1, or the full track speed [m/s].
  double fullCommand() const { return kind == CommandKind::kPower ? 1.0 : full_speed; }
  /// The channels of a drive command, in the range that max_command allows.
  CommandChannels channels() const;
};

/// What the robot does when its operator is lost: silent without having released the lease.
enum class OperatorLost {
  kStop,    ///< at once
  kFinish,  ///< completes the running pattern, then stops
  kGoBack   ///< stops, then returns to where the link was good
};

/// How operation depends on the operator.
struct OperatorRules {
  int64_t lease_us = 1'000'000;  ///< [us] for which a sighting by the operator counts
  OperatorLost lost = OperatorLost::kStop;
  int64_t return_us = 180'000'000;  ///< [us] with kGoBack: time limit of the return after the loss
  /// [us] after which an armed robot at standstill is disarmed if no operator program runs.
  int64_t wait_us = 30'000'000;
};

/// Hard tilt limits, at which the motor bridge stops the robot before it tips over.
struct TiltLimits {
  double roll = 0.0;        ///< [rad] to either side
  double pitch = 0.0;       ///< [rad] nose up or down
  double roll_rate = 1.0;   ///< [rad/s]
  double pitch_rate = 1.0;  ///< [rad/s]
};

/// One robot: everything that more than one process or tool must know about it. No defaults where
/// no value fits every robot.
struct RobotDescription {
  std::string name;
  FootprintSize outline;    ///< the body seen from above
  FootprintSize footprint;  ///< kept free by plans: the outline, and what swings beyond it in turns
  double height = 0.0;      ///< [m] above the ground
  /// [m] between the middles of the tracks, or of a car's rear wheels; of a holonomic base, the
  /// diameter of the circle around its wheels.
  double gauge = 0.0;
  DriveDescription drive;
  Mounting ins;  ///< p_body: the point whose position the INS reports
  Mounting range_finder;
  std::optional<Mounting> ground_finder;  ///< a second one that looks down at the ground ahead
  double max_speed = 0.0;                 ///< [m/s] top speed: a faster measurement is an INS error
  std::optional<double> max_tilt;   ///< [rad] executions on steeper slopes are not learned from
  std::optional<TiltLimits> tilt;   ///< nullopt: not monitored, for an INS without attitude
  std::optional<double> max_slope;  ///< [rad] plans avoid steeper ground; nullopt: no limit
  double stopping_time = 0.5;       ///< [s] at its speed that it continues after a zero command
  std::vector<Fence> fences;
  OperatorRules operators;
};

/// The robot of a process: the content of its key `robot`, or the file it names, else robot.yaml
/// beside the process's own file.
/** Strict; throws ConfigError with file:line. reader.effective() then includes the description, so
 * that a logged CONFIG can be read without the file. */
RobotDescription readRobot(ConfigReader& reader);

/// Whether a logged description contains operator leases. Older ones do not: their robots drove
/// without leases.
bool describesOperators(ConfigReader& reader);

/// Three keys that are all required: front, rear and half_width [m].
FootprintSize readFootprint(ConfigReader reader);

}  // namespace tread
