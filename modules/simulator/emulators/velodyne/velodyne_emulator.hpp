// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "modules/simulator/emulators/emulator.hpp"

namespace tread::sim {

/// Faults of the device or its line, from now on.
struct VelodyneFaults {
  bool silent = false;       ///< sends nothing
  bool lost_packet = false;  ///< each third packet is lost
  bool half_packet = false;  ///< packets break off in the middle
  bool wrong_flag = false;   ///< the flag of a block in each packet is wrong
  bool dual_return = false;  ///< no fault: each firing is sent twice, strongest and last are equal
  bool other_product = false;  ///< packets are those of an HDL-32E
};

/// A Velodyne VLP-16 that turns ten times a second and sends each packet when it is full (manual
/// 63-9243, section 9). It accepts no commands.
/** The simulated laser has one plane: the two lasers nearest to it (1 degree up and down) get its
 * ranges, the others no returns. */
class VelodyneEmulator final : public LaserEmulator {
 public:
  explicit VelodyneEmulator(const LaserParameters& laser) : laser_(laser) {}

  void receive(std::string_view /*bytes*/, int64_t /*utime*/) override {}
  void add(const LaserScan& scan) override;
  std::string transmit(int64_t utime) override;
  /// Power cycle: its clock restarts.
  void reboot(int64_t utime);
  void setFaults(const VelodyneFaults& faults) { faults_ = faults; }

 private:
  std::string packet() const;
  uint16_t ticksAt(double azimuth) const;
  void spoil(std::string& packet) const;

  LaserParameters laser_;
  VelodyneFaults faults_;
  LaserScan scan_;
  double firing_ = 0.0;   ///< [us] of the next packet's first firing
  double powered_ = 0.0;  ///< [us] at which its clock was zero
  int64_t sent_ = 0;
};

}  // namespace tread::sim
