// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>

namespace tread {

/// A value without its first `width`: 0 up to there, the rest beyond, sign kept.
inline double deadZone(double value, double width) {
  const double rest = std::abs(value) - width;
  return rest <= 0.0 ? 0.0 : std::copysign(rest, value);
}

}  // namespace tread
