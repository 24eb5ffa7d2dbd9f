// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>

#include "modules/simulator/emulators/serial_motor_emulator.hpp"

namespace tread::sim {

/// A Sabertooth 2x controller in packet serial mode at address 128, according to its manual.
/** Ignores everything after power-up until the bauding character 170; then packets of address,
 * command, value and 7-bit sum. It never answers. Its serial timeout is off after power-up, is
 * restarted by any good packet, and stops both motors. */
class SabertoothEmulator final : public SerialMotorEmulator {
 public:
  SabertoothEmulator() : SerialMotorEmulator(38400, 0, 200'000) {}

  MotorValues output(int64_t utime) override;
  void measure(const DriveMeasurements& /*measurements*/) override {}
  int64_t timeoutUs() const { return timeout_us_; }
  int64_t badSums() const { return bad_sums_; }

 private:
  void run(int64_t utime) override;
  void powerUp(int64_t utime) override;
  void hear(char byte, int64_t utime) override;
  void execute(int command, int value);

  std::array<int, 4> packet_{};
  int length_ = 0;  ///< bytes of the packet so far
  bool bauded_ = false;
  std::array<int, 2> power_{0, 0};  ///< of 127
  int64_t timeout_us_ = 0;          ///< 0 = off
  int64_t heard_at_ = 0;
  int64_t bad_sums_ = 0;
};

}  // namespace tread::sim
