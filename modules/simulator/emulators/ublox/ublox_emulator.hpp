// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/simulator/emulators/binary_ins_emulator.hpp"

namespace tread::sim {

/// A u-blox receiver with a moving base and sensor fusion: ESF-INS, NAV-PVT, NAV-ATT,
/// NAV-RELPOSNED with each measurement.
/** Vehicle frame: forward, right, down. Positions are in steps of 1e-7 degree: 1 cm. */
class UbloxEmulator final : public BinaryInsEmulator {
 public:
  using BinaryInsEmulator::BinaryInsEmulator;

 protected:
  void say(const InsMeasurement& sample, const EarthFix& fix, bool valid) override;

 private:
  void sendUbx(uint8_t message_class, uint8_t id, const std::string& payload);
};

}  // namespace tread::sim
