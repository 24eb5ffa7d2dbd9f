// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/study/hide/effect_list.hpp"
#include "tests/study/hide/programme.hpp"
#include "tests/study/hide/test_field.hpp"

namespace tread::blind {

/// True states every 10 ms.
struct Track {
  static constexpr int64_t kStepUs = 10'000;

  std::vector<Pose2> T_map_body;   ///< true poses including ground noise; yaw unwrapped
  std::vector<Pose2> T_map_clean;  ///< the same speeds without the ground's noise
  std::vector<Twist2> v_body;      ///< with the ground's noise
  std::vector<Twist2> v_clean;     ///< without
  std::vector<float> pitch;        ///< nose down positive [rad]
  std::vector<float> roll;         ///< left side up positive [rad]
  std::vector<float> height;       ///< of the ground [m]
};

/// Motor measurements of motor_bridge at each command.
struct MotorSample {
  double voltage = 0.0;        ///< [V]
  double current_left = 0.0;   ///< [A]
  double current_right = 0.0;  ///< [A]
};

/// One drive of one vehicle.
struct HiddenDrive {
  Programme programme;
  Track track;
  std::vector<MotorSample> motor;  ///< one per command period
};

/// A hider with its name and size.
struct Hidden {
  const EffectSpec* spec = nullptr;
  double size = 0.0;
  Hider hider;
};

/// The hiders of a case, in the order of the power path, determined by the seed.
std::vector<Hidden> makeHidden(const std::vector<std::string>& effects, double size,
                               double duration, uint64_t seed);

/// Drives a programme at 1 kHz. Programme, ground and noise depend on the seed only, not on the
/// hidden effects. Hiders have state: use them once.
HiddenDrive drive(const Programme& programme, std::vector<Hidden> hidden, const NoiseLevel& noise,
                  uint64_t seed);

/// Means of the steady half of each pattern, for a drive and its twin without effects.
Comparison compare(const HiddenDrive& with, const HiddenDrive& without);

}  // namespace tread::blind
