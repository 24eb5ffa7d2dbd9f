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

/// Kinds of motion patterns in a programme.
enum class Choice {
  kFull,         ///< the complete command space
  kFiveForward,  ///< five forward patterns
  kForward,      ///< the complete command space, forwards only
  kOneSpeed,     ///< one speed, one difference, in both directions, and stops
  kStraight,     ///< one speed straight ahead, and stops
};

/// The name in files: full, five_forward, forward, one_speed, straight.
std::string choiceName(Choice choice);
/// The choice of a name; nullopt for other names.
std::optional<Choice> choiceNamed(const std::string& name);

/// One command held for 2 s.
struct Pattern {
  int64_t start = 0;  ///< [us] since the programme began
  int64_t run = 1;    ///< increases after each rest
  int32_t pattern_id = 1;
  sim::MotorPower power;  ///< -1..1
};

/// A drive: rest, patterns without a gap, a rest in the middle, patterns, rest.
struct Programme {
  int64_t duration = 0;           ///< [us], a multiple of kCommandUs
  std::vector<Pattern> patterns;  ///< ordered by time

  /// Index of the pattern at a time [us]; -1 at rest.
  int at(int64_t time) const;
};

/// A random programme, determined by the seed.
Programme makeProgramme(Choice choice, double minutes, uint64_t seed);

}  // namespace tread::blind
