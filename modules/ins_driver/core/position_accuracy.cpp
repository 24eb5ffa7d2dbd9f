// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/core/position_accuracy.hpp"

#include <cmath>
#include <limits>

namespace tread::ins {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double rangeError(FixQuality quality) {
  switch (quality) {
    case FixQuality::kStandard:
    case FixQuality::kPrecise:
      return 3.9;
    case FixQuality::kDifferential:
    case FixQuality::kAugmented:
      return 1.0;
    case FixQuality::kRtkFixed:
      return 0.02;
    case FixQuality::kRtkFloat:
      return 0.4;
    default:
      return kNaN;
  }
}

}  // namespace

Eigen::Vector3d positionStd(const Gga& gga) {
  const double horizontal = rangeError(gga.quality) * gga.hdop.value_or(kNaN) / std::sqrt(2.0);
  return {horizontal, horizontal, 2.0 * horizontal};
}

}  // namespace tread::ins
