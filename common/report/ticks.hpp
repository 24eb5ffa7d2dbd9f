// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/report/text.hpp"

namespace tread::report {

/// A step of 1, 2 or 5 times a power of ten that cuts a range into about so many pieces.
inline double tickStep(double range, int pieces) {
  const double rough = range / pieces;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= rough) return factor * power;
  return 10.0 * power;
}

/// Whole multiples of a step within a range.
inline std::vector<double> ticks(double low, double high, double step) {
  std::vector<double> all;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1.0)
    all.push_back(k == 0.0 ? 0.0 : k * step);
  return all;
}

/// The number beside a tick, with the decimals that its step needs.
inline std::string tickText(double value, double step) {
  return fixed(value, std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 6));
}

}  // namespace tread::report
