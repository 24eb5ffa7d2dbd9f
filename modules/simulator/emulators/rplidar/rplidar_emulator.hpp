// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <utility>

#include "modules/simulator/emulators/emulator.hpp"

namespace tread::sim {

/// Faults of the device or its line, from now on.
struct RplidarFaults {
  bool silent = false;        ///< receives but does not send
  bool bad_check = false;     ///< one sample of each revolution has wrong check bits
  bool dropped_byte = false;  ///< one byte of each revolution is missing
  bool half_turn = false;     ///< the second half of each revolution is missing
  bool ill = false;           ///< its health status is error
  /// [deg] by which angles of samples with an echo lag behind those without
  double correction = 0.0;
};

/// An RPLIDAR in SCAN mode: STOP, RESET, SCAN, GET_INFO, GET_HEALTH, motor (LR001, protocol v2.8).
/** A revolution of 360 samples, clockwise, unevenly spaced; each is sent when it would be measured,
 * so that a revolution is complete one period after the simulated sweep. There are no returns
 * outside the laser's field of view. */
class RplidarEmulator final : public LaserEmulator {
 public:
  explicit RplidarEmulator(const LaserParameters& laser) : laser_(laser) {}

  void receive(std::string_view bytes, int64_t utime) override;
  void add(const LaserScan& scan) override;
  std::string transmit(int64_t utime) override;
  void reboot();  ///< sends its banner and waits for commands
  void setFaults(const RplidarFaults& faults) { faults_ = faults; }

 private:
  void run(char command);

  LaserParameters laser_;
  RplidarFaults faults_;
  std::string in_;
  std::string out_;
  std::deque<std::pair<int64_t, std::string>> samples_;  ///< with their times of sending
  bool scanning_ = false;
};

}  // namespace tread::sim
