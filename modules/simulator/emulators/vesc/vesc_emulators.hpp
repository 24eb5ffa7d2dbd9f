// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "modules/simulator/emulators/serial_motor_emulator.hpp"
#include "modules/simulator/emulators/vesc/vesc_motor.hpp"

namespace tread::sim {

/// Controllers that drive two channels, odd ids the first, even ids the second, or more in turn.
/// With a servo, the servo is the second: -1..1 from its position 0.1 to 0.9, which it keeps
/// independent of the motors' timeout.
class VescBank {
 public:
  explicit VescBank(const VescSettings& settings);

  /// The one with this id; null if there is none.
  VescMotor* find(int id);
  std::vector<VescMotor>& motors() { return motors_; }
  MotorValues output(int64_t utime);
  MotorValues heldSpeeds() const;
  void setServo(double position) { servo_ = position; }
  void measure(const DriveMeasurements& measurements);
  void powerUp();

 private:
  std::vector<VescMotor> motors_;
  size_t channels_;
  bool has_servo_;
  double servo_ = 0.5;
};

/// VESC controllers behind the UART of the one with id 1, according to the firmware's packet.c and
/// commands.c: COMM_FW_VERSION, GET_VALUES, SET_DUTY, SET_CURRENT_BRAKE, SET_RPM, SET_SERVO_POS,
/// GET_APPCONF, ALIVE, FORWARD_CAN. Other commands are not answered.
class VescUartEmulator final : public SerialMotorEmulator {
 public:
  explicit VescUartEmulator(const VescSettings& settings = {});

  MotorValues output(int64_t utime) override;
  std::optional<MotorValues> heldSpeeds() const override { return bank_.heldSpeeds(); }
  void measure(const DriveMeasurements& measurements) override { bank_.measure(measurements); }
  VescBank& bank() { return bank_; }

 private:
  void run(int64_t utime) override { bank_.output(utime); }
  void powerUp(int64_t utime) override;
  void hear(char byte, int64_t utime) override;
  void execute(VescMotor& motor, const std::string& payload, int64_t utime);
  void answer(const std::string& payload, int64_t utime);

  VescBank bank_;
  std::string heard_;
};

/// VESC controllers on a CAN bus, as a stream of struct can_frame: SET_DUTY, SET_CURRENT_BRAKE and
/// SET_RPM in, STATUS, STATUS_4 and STATUS_5 at 50 Hz out.
class VescCanEmulator final : public MotorEmulator {
 public:
  explicit VescCanEmulator(const VescSettings& settings = {})
      : settings_(settings), bank_(settings) {}

  void receive(std::string_view bytes, int64_t utime) override;
  std::string transmit(int64_t utime) override;
  MotorValues output(int64_t utime) override { return bank_.output(utime); }
  std::optional<MotorValues> heldSpeeds() const override { return bank_.heldSpeeds(); }
  void measure(const DriveMeasurements& measurements) override { bank_.measure(measurements); }
  VescBank& bank() { return bank_; }

  // Faults.
  void reboot(int64_t utime);
  void setSilent(bool silent) { silent_ = silent; }

 private:
  VescSettings settings_;
  VescBank bank_;
  std::string heard_;
  int64_t next_status_ = 0;
  int64_t deaf_until_ = INT64_MIN;
  bool silent_ = false;
};

}  // namespace tread::sim
