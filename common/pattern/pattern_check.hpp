// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>

#include "common/pattern/pattern.hpp"

namespace tread {

/// What PatternSet::make allows; the file reader tells people the same limits.
struct PatternLimits {
  static constexpr double kMaxSpeed = 20.0;       ///< [m/s], track commands, twists and steps of R
  static constexpr double kMaxYawRate = 20.0;     ///< [rad/s]
  static constexpr int64_t kMinPeriodUs = 5'000;  ///< [us]
  static constexpr int64_t kMaxPeriodUs = 1'000'000;  ///< [us]
  static constexpr size_t kMaxPatterns = 1000;
  static constexpr size_t kMaxSamples = 1000;
  static constexpr size_t kMaxNameLength = 64;
};

/// Largest magnitude of a command of a kind: 1 for power, PatternLimits::kMaxSpeed for track speed.
double commandLimit(CommandKind kind);

/// One thing that is wrong in a set, and where, so that a file reader can point at the line.
struct PatternProblem {
  enum class Place { kSet, kClass, kPattern };
  Place place = Place::kSet;
  size_t index = 0;     ///< of the class or pattern in the content
  std::string key;      ///< what is wrong in the words of the pattern file, for instance "commands"
  std::string problem;  ///< "what is wrong; what is allowed", without the place

  /// One line with the place in words: "pattern 'left': ...".
  std::string line(const PatternSetContent& content) const;
};

/// The first thing that is wrong in a set; nothing if all is well.
std::optional<PatternProblem> firstProblem(const PatternSetContent& content);

}  // namespace tread
