// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/simulator/emulators/binary_ins_emulator.hpp"

namespace tread::sim {

/// A SPAN receiver that sends BESTPOS, CORRIMUDATA (short header) and INSPVAX with each
/// measurement.
/** Vehicle frame: right, forward, up; roll right side down, pitch nose up; rates in radians per
 * sample of a 200 Hz IMU. Without a solution the logs' status says so. */
class NovatelEmulator final : public BinaryInsEmulator {
 public:
  using BinaryInsEmulator::BinaryInsEmulator;

 protected:
  void say(const InsMeasurement& sample, const EarthFix& fix, bool valid) override;

 private:
  void sendLong(uint16_t id, const EarthFix& fix, const std::string& body);
  void sendShort(uint16_t id, const EarthFix& fix, const std::string& body);
};

}  // namespace tread::sim
