// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/simulator/emulators/binary_ins_emulator.hpp"

namespace tread::sim {

/// An Xsens MTi-680 that sends one MTData2 with each measurement, and GnssPvtData in four of them
/// per second.
/** Axes: forward, left, up; orientation and velocity over east, north, up. Angular rates and the
 * quaternion are single precision, positions and velocities fixed point 16.32. */
class XsensEmulator final : public BinaryInsEmulator {
 public:
  using BinaryInsEmulator::BinaryInsEmulator;

 protected:
  void say(const InsMeasurement& sample, const EarthFix& fix, bool valid) override;

 private:
  int64_t last_pvt_ = -1'000'000;  // [us]
};

}  // namespace tread::sim
