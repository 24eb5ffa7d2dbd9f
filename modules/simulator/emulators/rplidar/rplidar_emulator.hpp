// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <utility>

#include "modules/simulator/emulators/emulator.hpp"

namespace tread::sim {

/// What is wrong with the device or its line, from then on.
struct RplidarFaults {
  bool silent = false;        ///< hears and says nothing
  bool bad_check = false;     ///< one sample of each turn has wrong check bits
  bool dropped_byte = false;  ///< one byte of each turn is missing
  bool half_turn = false;     ///< the second half of each turn is missing
  bool ill = false;           ///< its health is error
  double correction = 0.0;    ///< [deg] by which samples with an echo are told behind those without
};

/// An RPLIDAR in SCAN mode: STOP, RESET, SCAN, GET_INFO, GET_HEALTH, motor (LR001, protocol v2.8).
/** A turn of 360 samples, clockwise, unevenly spaced; each leaves when it would be measured, so
 * that a turn is out one period after the simulated sweep. Outside the laser's field of view
 * nothing is seen. */
class RplidarEmulator final : public LaserEmulator {
 public:
  explicit RplidarEmulator(const LaserParameters& laser) : laser_(laser) {}

  void receive(std::string_view bytes, int64_t utime) override;
  void add(const LaserScan& scan) override;
  std::string transmit(int64_t utime) override;
  void reboot();  ///< says its banner and waits for commands
  void setFaults(const RplidarFaults& faults) { faults_ = faults; }

 private:
  void run(char command);

  LaserParameters laser_;
  RplidarFaults faults_;
  std::string in_;
  std::string out_;
  std::deque<std::pair<int64_t, std::string>> samples_;  ///< with the times at which they leave
  bool scanning_ = false;
};

}  // namespace tread::sim
