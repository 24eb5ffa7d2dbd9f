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

/// A car's steering servo, at a controller's servo output.
struct VescServo {
  int id = 1;                 ///< of that controller
  double at_left = 0.9;       ///< position, 0..1, at the largest angle to the left
  double at_right = 0.1;      ///< and to the right
  double max_steering = 0.5;  ///< [rad] that angle
};

/// VESC motor controllers of a robot: one or two on each side, those of a car's throttle, or one
/// per wheel of a holonomic base.
struct VescConfig {
  std::vector<int> left{
      1};  ///< CAN ids of the controllers of the left track (or wheels); for a car, of all
  std::vector<int> right{2};
  std::vector<int> wheels;          ///< of a holonomic base, in order, instead of left and right
  std::vector<bool> invert_wheels;  ///< the same wheels
  std::optional<VescServo> servo;   ///< of a car
  int local = 1;  ///< over UART: id of the one on the line, which forwards to the others
  CommandKind kind = CommandKind::kPower;
  bool invert_left = false;
  bool invert_right = false;
  double full_scale = 1.0;     ///< command for full duty, for power
  double erpm_per_mps = 0.0;   ///< electrical rpm at 1 m/s of track [rpm s/m]; 0 = unknown
  double brake_current = 0.0;  ///< [A] at zero; 0 = duty or speed zero instead
  ConnectionTimes times;

  std::vector<int> ids() const;
  /// The command channel that a controller drives.
  size_t channelOf(int id) const;
  bool inverted(size_t channel) const;
};

/// Reads the section `vesc` or `vesc_can`; throws ConfigError with file:line.
VescConfig readVescConfig(ConfigReader& reader, const DriveDescription& drive);

/// One controller's part of a command. NaN becomes zero.
VescCommand vescCommand(const Command& command, int id, const VescConfig& config);
/// The servo's position for a command of a car. NaN becomes straight ahead.
VescCommand servoCommand(const Command& command, const VescConfig& config);

/// All controllers of a robot, with their latest data.
class VescGroup {
 public:
  explicit VescGroup(const VescConfig& config);

  void begin(int64_t now);
  /// False if it is from no controller of this robot.
  bool take(const VescReading& reading, int64_t now);
  /// Ids silent for longer than a time [us], in words; empty = none.
  std::string silent(int64_t now, int64_t limit_us) const;
  /// Ids without data since begin(), in words.
  std::string unheard() const;
  MotorTelemetry telemetry() const;
  /// Fault codes in words; empty = none.
  std::string faults() const;
  /// Whether one of them concerns the battery's voltage.
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
