// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <cstdint>

namespace tread::sim {

/// Configuration of the emulated VESC controllers.
struct VescSettings {
  /// Ids 1, 2 (left, right) or 1 to 4 (left, right, left, right); 1 with a servo; 1 to n for n
  /// wheels.
  int controllers = 2;
  size_t channels = 2;
  int64_t timeout_ms = 200;  ///< time without a command until the motor is released; 0 = never
  double erpm_per_mps = 5000.0;
  bool statuses = true;  ///< CAN status messages are switched on
  bool servo = false;    ///< the first one steers: its servo output is the second channel
};

/// The firmware of one controller: its command, its timeout, its speed control.
class VescMotor {
 public:
  VescMotor(int id, const VescSettings& settings) : id_(id), settings_(settings) {}

  void setDuty(double duty, int64_t utime);
  void setRpm(double erpm, int64_t utime);
  void setBrake(double amperes, int64_t utime);
  /// COMM_ALIVE: restarts the timeout, the present command continues.
  void keepAlive(int64_t utime) { fed_ = utime; }
  void measure(double track_speed, double current, double battery);
  void setFault(int code) { fault_ = code; }
  void powerUp();

  /// Motor power at a time, -1..1.
  double output(int64_t utime);

  /// [m/s] set point of its speed control; 0 in the other modes.
  double heldSpeed() const { return mode_ == Mode::kRpm ? wanted_ / settings_.erpm_per_mps : 0.0; }

  int id() const { return id_; }
  int fault() const { return fault_; }
  int64_t timeoutMs() const { return settings_.timeout_ms; }
  double erpm() const { return erpm_; }
  double current() const { return current_; }
  double battery() const { return battery_; }
  double duty() const { return power_; }

 private:
  enum class Mode { kReleased, kDuty, kRpm };
  void set(Mode mode, double wanted, int64_t utime);

  int id_;
  VescSettings settings_;
  Mode mode_ = Mode::kReleased;
  double wanted_ = 0.0;
  double sum_ = 0.0;  ///< of the speed control's error
  double power_ = 0.0;
  double erpm_ = 0.0;
  double current_ = 0.0;
  double battery_ = 25.0;
  int fault_ = 0;
  int64_t fed_ = 0;
  int64_t stepped_ = 0;
};

}  // namespace tread::sim
