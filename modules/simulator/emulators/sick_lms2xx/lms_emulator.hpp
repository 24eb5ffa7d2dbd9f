// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <string_view>

#include "modules/simulator/emulators/emulator.hpp"

namespace tread::sim {

/// Faults of the device or its line, from now on.
struct LmsFaults {
  bool silent = false;        ///< receives but does not send
  bool bad_checksum = false;  ///< scans have a wrong one
  bool half_frame = false;    ///< scans break off in the middle
  bool dropped_byte = false;  ///< scans lack one byte
};

/// A SICK LMS 2xx on its serial line: 20 (modes 24, 25), 31, 3B, 74 (telegrams for LMS2xx).
/** 180 degrees with a value per degree or half degree, in mm of 13 bits (up to 8.18 m). */
class LmsEmulator final : public LaserEmulator {
 public:
  explicit LmsEmulator(const LaserParameters& laser) : laser_(laser) {}

  void receive(std::string_view bytes, int64_t utime) override;
  void add(const LaserScan& scan) override;
  std::string transmit(int64_t utime) override;
  /// Power cycle: resets to 1 degree without scans. The line has no connection state.
  void reboot();
  void setFaults(const LmsFaults& faults) { faults_ = faults; }

 private:
  void run(const std::string& command);
  void answer(std::string payload);

  LaserParameters laser_;
  LmsFaults faults_;
  std::string in_;
  std::string out_;
  bool streaming_ = false;
  int per_degree_ = 1;
};

}  // namespace tread::sim
