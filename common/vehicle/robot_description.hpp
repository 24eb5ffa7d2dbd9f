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

/// What a vehicle stands on and is moved by.
enum class DriveLayout {
  kTracks,            ///< two, a motor each
  kSkidSteer4,        ///< four wheels that are not steered, a motor each
  kThrottleSteering,  ///< a car: rear wheels driven together, front wheels steered
  kOmni  ///< three or more wheels with rollers, a motor each: it goes in all directions
};

/// What drives the tracks or wheels, and how it is wired.
struct DriveDescription {
  DriveLayout layout = DriveLayout::kTracks;
  CommandKind kind = CommandKind::kPower;  ///< of the tracks or the throttle
  /// [m/s] of a track, or of a wheel's rim, at full command; of a car straight ahead.
  double full_speed = 0.0;
  double max_command = 0.0;  ///< largest magnitude of a command: power [1] or track speed [m/s]
  int left_channel = 1;      ///< 1 or 2, of the motor controller; the right track has the other one
  bool invert_left = false;  ///< the left motor is mounted the other way round; a car's throttle
  bool invert_right = false;  ///< a car's steering
  double wheelbase = 0.0;  ///< [m] of a car, between its axles; the body origin is on the rear one
  double max_steering = 0.0;        ///< [rad] of a car, to either side
  OmniWheels wheels;                ///< of a holonomic base; else none
  std::vector<bool> invert_wheels;  ///< whether each one's motor is mounted the other way round

  bool isCar() const { return layout == DriveLayout::kThrottleSteering; }
  bool isOmni() const { return layout == DriveLayout::kOmni; }
  /// [m/s] of the fastest point between the wheels: wheels that push together move a base faster
  /// than their rims.
  double topSpeed() const { return isOmni() ? full_speed * wheels.reach() : full_speed; }
  /// Command at which the controller gives all it can: power 1, or the full track speed [m/s].
  double fullCommand() const { return kind == CommandKind::kPower ? 1.0 : full_speed; }
  /// What a command to the drive consists of, in the range that max_command allows.
  CommandChannels channels() const;
};

/// What the robot does when its operator is lost: silent without having let go.
enum class OperatorLost {
  kStop,    ///< at once
  kFinish,  ///< ends what runs, then stops
  kGoBack   ///< stops, then returns to where the link was good
};

/// How the robot depends on its operator.
struct OperatorRules {
  int64_t lease_us = 1'000'000;  ///< [us] for which it counts what the operator has seen
  OperatorLost lost = OperatorLost::kStop;
  int64_t return_us = 180'000'000;  ///< [us] with kGoBack: the return ends so long after the loss
  /// [us] after which an armed robot that stands is disarmed if no operator's program runs.
  int64_t wait_us = 30'000'000;
};

/// What tips the robot over, or comes near it: hard limits, at which the motor bridge stops.
struct TiltLimits {
  double roll = 0.0;        ///< [rad] to either side
  double pitch = 0.0;       ///< [rad] nose up or down
  double roll_rate = 1.0;   ///< [rad/s]
  double pitch_rate = 1.0;  ///< [rad/s]
};

/// One robot: all that more than one process or tool has to know of it. Nothing has a default that
/// would fit any robot.
struct RobotDescription {
  std::string name;
  FootprintSize outline;    ///< the body seen from above
  FootprintSize footprint;  ///< what plans keep free: the outline, and what turns swing beyond it
  double height = 0.0;      ///< [m] above the ground
  /// [m] between the middles of the tracks, or of a car's rear wheels; of a holonomic base, the
  /// diameter of the circle around its wheels.
  double gauge = 0.0;
  DriveDescription drive;
  Mounting ins;  ///< p_body: the point whose position the INS reports
  Mounting range_finder;
  std::optional<Mounting> ground_finder;  ///< one more that looks down at the ground ahead
  double max_speed = 0.0;           ///< [m/s] it is never faster: what is, is an error of the INS
  std::optional<double> max_tilt;   ///< [rad] what it drives on a steeper slope teaches nothing
  std::optional<TiltLimits> tilt;   ///< nothing: not watched, for an INS without attitude
  std::optional<double> max_slope;  ///< [rad] plans keep off steeper ground; nothing: no such rule
  double stopping_time = 0.5;       ///< [s] at its speed that it goes on after a zero command
  std::vector<Fence> fences;
  OperatorRules operators;
};

/// The robot of a process: what its key `robot` holds or the file that it names, else robot.yaml
/// beside the process's own file.
/** Strict; throws ConfigError with file:line. reader.effective() then holds the description, too,
 * so that a logged CONFIG can be read without the file. */
RobotDescription readRobot(ConfigReader& reader);

/// Whether a description that was logged with a configuration knows of operator leases. Older ones
/// do not, and what they say was driven without.
bool describesOperators(ConfigReader& reader);

/// Three keys that are all required: front, rear and half_width [m].
FootprintSize readFootprint(ConfigReader reader);

}  // namespace tread
