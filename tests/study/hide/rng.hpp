// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <random>

namespace tread::blind {

/// Uniform random numbers, the same with every standard library.
class Rng {
 public:
  explicit Rng(uint64_t seed) : generator_(seed) {}

  /// Uniform in [low, high).
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(generator_() >> 11) * 0x1.0p-53;
  }
  /// 0 .. count - 1.
  int below(int count) { return static_cast<int>(uniform(0.0, static_cast<double>(count))); }
  double sign() { return uniform(-1.0, 1.0) < 0.0 ? -1.0 : 1.0; }
  uint64_t word() { return generator_(); }

 private:
  std::mt19937_64 generator_;
};

/// Independent random streams of a case: the effect influences neither programme nor noise.
enum Stream : uint64_t {
  kProgrammeStream = 100,
  kTerrainStream,
  kGroundNoiseStream,
  kInsStream,
  kClockStream,
  kEffectStream,
  kSuiteStream = 107,
  kSecondRobotStream,
  kBatteryStream,
};

}  // namespace tread::blind
