// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "modules/simulator/core/vehicle.hpp"

namespace tread::blind {

inline constexpr int64_t kCommandUs = 50'000;   ///< a command is held this long
inline constexpr int kCommandsPerPattern = 40;  ///< 2 s
inline constexpr int64_t kPatternUs = kCommandsPerPattern * kCommandUs;
inline constexpr double kPatternSeconds = 2.0;

/// Which motion patterns a programme is made of.
enum class Choice {
  kFull,         ///< the whole command space
  kFiveForward,  ///< five forward patterns
  kForward,      ///< the whole command space, forwards only
  kOneSpeed,     ///< one speed, one differential, either way, and stops
  kStraight,     ///< one speed straight ahead, and stops
};

/// The name in files: full, five_forward, forward, one_speed, straight.
std::string choiceName(Choice choice);
/// The choice of a name; nothing for another name.
std::optional<Choice> choiceNamed(const std::string& name);

/// One command held for two seconds.
struct Pattern {
  int64_t start = 0;  ///< [us] since the programme began
  int64_t run = 1;    ///< counts up after each rest
  int32_t pattern_id = 1;
  sim::MotorPower power;  ///< -1..1
};

/// A drive: standing, patterns without a gap, a rest in the middle, patterns, standing.
struct Programme {
  int64_t duration = 0;           ///< [us], a multiple of kCommandUs
  std::vector<Pattern> patterns;  ///< in order of time

  /// Index of the pattern that plays at a time [us]; -1 while standing.
  int at(int64_t time) const;
};

/// A random programme; same seed, same programme.
Programme makeProgramme(Choice choice, double minutes, uint64_t seed);

}  // namespace tread::blind
