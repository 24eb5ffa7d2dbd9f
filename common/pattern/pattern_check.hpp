// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

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

/// The first thing that is wrong in a set, as one line "where: what; what is allowed"; empty if all
/// is well.
std::string firstProblem(const PatternSetContent& content);

}  // namespace tread
