// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "modules/simulator/emulators/emulator.hpp"

namespace tread::sim {

/// What is wrong with the device or its line, from then on.
struct VelodyneFaults {
  bool silent = false;         ///< sends nothing
  bool lost_packet = false;    ///< each third packet does not arrive
  bool half_packet = false;    ///< packets end in their middle
  bool wrong_flag = false;     ///< the flag of a block in each packet is another one
  bool dual_return = false;    ///< no fault: each firing is told twice, strongest and last alike
  bool other_product = false;  ///< packets are those of an HDL-32E
};

/// A Velodyne VLP-16 that turns ten times a second and sends each packet when it is full (manual
/// 63-9243, section 9). It listens to nobody.
/** The simulated laser looks into one plane: the two lasers nearest to it (1 degree up and down)
 * see what it sees, the others nothing. */
class VelodyneEmulator final : public LaserEmulator {
 public:
  explicit VelodyneEmulator(const LaserParameters& laser) : laser_(laser) {}

  void receive(std::string_view /*bytes*/, int64_t /*utime*/) override {}
  void add(const LaserScan& scan) override;
  std::string transmit(int64_t utime) override;
  /// Power off and on: its clock begins anew.
  void reboot(int64_t utime);
  void setFaults(const VelodyneFaults& faults) { faults_ = faults; }

 private:
  std::string packet() const;
  uint16_t ticksAt(double azimuth) const;
  void spoil(std::string& packet) const;

  LaserParameters laser_;
  VelodyneFaults faults_;
  LaserScan scan_;
  double firing_ = 0.0;   ///< [us] when the next packet's first firing is
  double powered_ = 0.0;  ///< [us] when its clock was zero
  int64_t sent_ = 0;
};

}  // namespace tread::sim
