// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/geometry/se2.hpp"

namespace tread {

/// For people, who use degrees; everything else is in radians.
constexpr double toDegrees(double angle) {
  return angle * 180.0 / kPi;
}
constexpr double toRadians(double degrees) {
  return degrees * kPi / 180.0;
}

}  // namespace tread
