// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>

namespace tread::learner {

/// No count of executions is beyond this; a double holds all whole numbers up to it.
inline constexpr double kMostExecutions = 9e15;

/// Whether a number from a file is a whole one in [0, most]: only then it may become an integer.
inline bool isCount(double number, double most) {
  return number >= 0.0 && number <= most && number == std::floor(number);
}

}  // namespace tread::learner
