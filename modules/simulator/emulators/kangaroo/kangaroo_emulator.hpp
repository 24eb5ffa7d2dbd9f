// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "modules/simulator/emulators/serial_motor_emulator.hpp"

namespace tread::sim {

/// A Kangaroo x2 in packet serial mode at address 128, tuned for speeds, according to its packet
/// serial reference.
/** A channel moves only between its Start and an event that stops it: a serial timeout (off after
 * power-up; any good packet restarts it), lost control, power-up. Only Get is answered, with the
 * speed or the error. */
class KangarooEmulator final : public SerialMotorEmulator {
 public:
  static constexpr double kUnitsPerMetre = 1000.0;

  KangarooEmulator() : SerialMotorEmulator(38400, 1'000, 500'000) {}

  MotorValues output(int64_t utime) override;
  std::optional<MotorValues> heldSpeeds() const override;
  void measure(const DriveMeasurements& measurements) override {
    measured_ = measurements.track_speed;
  }

  /// The channel (0 or 1) has lost its encoder.
  void loseControl(size_t channel) { stop(channels_[channel], 3); }
  int64_t timeoutUs() const { return timeout_us_; }
  int64_t badSums() const { return bad_sums_; }

 private:
  struct Channel {
    int error = 1;  ///< 0 = started
    int speed = 0;  ///< [units/s]
    double power = 0.0;
  };

  void run(int64_t utime) override;
  void powerUp(int64_t utime) override;
  void hear(char byte, int64_t utime) override;
  void execute(int64_t utime);
  void stop(Channel& channel, int error) { channel = {error, 0, 0.0}; }
  void tell(size_t channel, int64_t utime);
  /// The number at a position in the packet.
  int numberAt(size_t place) const;
  static int sumOf(const std::string& packet);

  std::string packet_;
  std::array<Channel, 2> channels_;
  MotorValues measured_{};  ///< [m/s]
  int64_t controlled_at_ = 0;
  int64_t timeout_us_ = 0;  ///< 0 = off
  int64_t heard_at_ = 0;
  int64_t bad_sums_ = 0;
};

}  // namespace tread::sim
