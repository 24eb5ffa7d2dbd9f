// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/config/config_reader.hpp"
#include "common/vehicle/robot_description.hpp"
#include "modules/motor_bridge/core/controller_connection.hpp"
#include "modules/motor_bridge/vesc/vesc_codec.hpp"

namespace tread::motor {

/// A car's steering servo, at the servo output of a controller.
struct VescServo {
  int id = 1;                 ///< of that controller
  double at_left = 0.9;       ///< position, 0..1, at the largest angle to the left
  double at_right = 0.1;      ///< and to the right
  double max_steering = 0.5;  ///< [rad] that angle
};

/// VESC motor controllers of a robot: one or two on each side, those of a car's throttle, or one
/// for each wheel of a holonomic base.
struct VescConfig {
  std::vector<int> left{1};  ///< CAN ids of the left track's (or wheels') controllers; a car's all
  std::vector<int> right{2};
  std::vector<int> wheels;          ///< of a holonomic base, which has no left and right, in order
  std::vector<bool> invert_wheels;  ///< the same wheels
  std::optional<VescServo> servo;   ///< of a car
  int local = 1;                    ///< over UART: the one on the line; it forwards to the others
  CommandKind kind = CommandKind::kPower;
  bool invert_left = false;
  bool invert_right = false;
  double full_scale = 1.0;     ///< command that is full duty, for power
  double erpm_per_mps = 0.0;   ///< electrical rpm at 1 m/s of track [rpm s/m]; 0 = unknown
  double brake_current = 0.0;  ///< [A] at zero; 0 = duty or speed zero instead
  ConnectionTimes times;

  std::vector<int> ids() const;
  /// The channel of the commands that a controller drives.
  size_t channelOf(int id) const;
  bool inverted(size_t channel) const;
};

/// Reads the section `vesc` or `vesc_can`; throws ConfigError with file:line.
VescConfig readVescConfig(ConfigReader& reader, const DriveDescription& drive);

/// What one controller is to do for a command of the tracks. NaN becomes zero.
VescCommand vescCommand(const Command& command, int id, const VescConfig& config);
/// Where the servo is to be for a command of a car. NaN becomes straight ahead.
VescCommand servoCommand(const Command& command, const VescConfig& config);

/// All controllers of a robot, as they last told of themselves.
class VescGroup {
 public:
  explicit VescGroup(const VescConfig& config);

  void begin(int64_t now);
  /// False if it is of no controller of this robot.
  bool take(const VescReading& reading, int64_t now);
  /// Ids not heard for longer than a time [us], in words; empty = none.
  std::string silent(int64_t now, int64_t limit_us) const;
  /// Ids never heard since begin(), in words.
  std::string unheard() const;
  MotorTelemetry telemetry() const;
  /// Fault codes in words; empty = none.
  std::string faults() const;
  /// Whether one of them is the battery's voltage.
  bool voltageFault() const;

 private:
  struct Member {
    int id = 0;
    size_t channel = 0;
    int64_t heard_at = 0;
    bool heard = false;
    VescReading told;
  };
  double speedOf(size_t channel) const;
  double currentOf(size_t channel) const;

  VescConfig config_;
  std::vector<Member> members_;
};

}  // namespace tread::motor
