// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/simulator/emulators/binary_ins_emulator.hpp"

namespace tread::sim {

/// A VectorNav that sends one binary message with each measurement: groups common, time, attitude
/// and INS.
/** Axes: forward, right, down. Height is above the ellipsoid. */
class VectornavEmulator final : public BinaryInsEmulator {
 public:
  using BinaryInsEmulator::BinaryInsEmulator;

 protected:
  void say(const InsMeasurement& sample, const EarthFix& fix, bool valid) override;
};

}  // namespace tread::sim
