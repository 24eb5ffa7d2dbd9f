// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "modules/simulator/emulators/serial_motor_emulator.hpp"

namespace tread::sim {

/// Configuration of the emulated controller.
struct RoboteqSettings {
  int baud = 115200;
  int64_t reply_delay_us = 300;  ///< from the end of a line to the first byte of its reply
  int64_t boot_us = 400000;      ///< no input or output after a reboot
  bool encoders = false;         ///< with encoders ?S is answered
  double rpm_per_speed = 400.0;  ///< motor revolutions per minute over track speed [rpm s/m]
  double undervoltage = 18.0;    ///< the power stage switches off below it [V]
};

/// An upper-case line, parsed: name in letters, then numbers.
struct RoboteqWords {
  std::string name;
  std::vector<std::optional<int>> numbers;  ///< empty: not an integer
};
/// Parses a line without its first character.
RoboteqWords roboteqWords(const std::string& text);

/// The controller behind its serial port: commands, queries, settings, watchdog.
/** Two-channel Roboteq controller according to its manual (v2.0, 2019). Only '!' commands feed the
 * watchdog: when it expires the motors stop, and the next good '!' command of any kind resumes the
 * old speed. !EX latches bit 16 of ?FF until !MG, which also restores the old speed. Its memory
 * for settings and its history of queries are left out: no driver of ours uses them. Where the
 * manual is silent this assumes the behaviour that is worse for a careless driver. */
class RoboteqFirmware {
 public:
  explicit RoboteqFirmware(const RoboteqSettings& settings) : settings_(settings) {}

  /// Executes one upper-case line; returns its reply without CR, or nullopt if it has none.
  std::optional<std::string> execute(const std::string& line, int64_t utime);
  /// Updates the watchdog.
  void advance(int64_t utime);
  /// Back to the power-up state: default settings, zero, no active command source.
  void powerUp();
  void measure(const DriveMeasurements& measurements) { measurements_ = measurements; }
  /// The motor supply drops below the power stage's minimum, or recovers.
  void setBrownOut(bool active) { brown_out_ = active; }

  bool echo() const { return !configuration_.echo_off; }
  /// Present motor power, per mille.
  std::array<int, 2> applied() const;

 private:
  using Numbers = std::vector<std::optional<int>>;
  /// What ^ sets.
  struct Configuration {
    int watchdog_ms = 1000;
    bool echo_off = false;
  };

  bool runCommand(const RoboteqWords& words, int64_t utime);
  bool setBoth(const Numbers& numbers);
  bool setOne(const Numbers& numbers);
  bool stop(const Numbers& numbers);
  std::optional<std::string> answer(const RoboteqWords& words) const;
  std::optional<std::string> channelAnswer(const RoboteqWords& words) const;
  std::string voltages(const Numbers& numbers) const;
  bool setConfiguration(const RoboteqWords& words);
  std::optional<std::string> readConfiguration(const std::string& name) const;

  bool supplyLow() const;
  bool powerStageOn() const { return !emergency_stop_ && !supplyLow(); }

  RoboteqSettings settings_;
  DriveMeasurements measurements_;
  Configuration configuration_;
  std::array<int, 2> commanded_{0, 0};  ///< per mille, kept while not applied
  bool serial_active_ = false;          ///< false before the first command and after the watchdog
  bool emergency_stop_ = false;
  bool brown_out_ = false;
  int64_t last_command_ = 0;
};

/// A Roboteq controller at the end of a serial line: byte timing, echo, line ends, faults.
/** Lines end with CR or '_'; other characters below space are ignored. Echo is on after power-up:
 * each character is returned before the reply. */
class RoboteqEmulator final : public SerialMotorEmulator {
 public:
  explicit RoboteqEmulator(const RoboteqSettings& settings = {});

  MotorValues output(int64_t utime) override;
  void measure(const DriveMeasurements& measurements) override { firmware_.measure(measurements); }
  /// The motor supply drops below the power stage's minimum, or recovers.
  void setBrownOut(bool active) { firmware_.setBrownOut(active); }

 private:
  void run(int64_t utime) override { firmware_.advance(utime); }
  void powerUp(int64_t utime) override;
  void hear(char byte, int64_t utime) override;
  void endLine(int64_t utime);

  RoboteqFirmware firmware_;
  std::string line_;
};

}  // namespace tread::sim
