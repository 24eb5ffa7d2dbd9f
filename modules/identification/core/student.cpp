// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/student.hpp"

#include <algorithm>
#include <cmath>

namespace tread::gap {

double studentQuantile(double freedom, double normal_quantile) {
  const double z = normal_quantile;
  const double n = std::max(3.0, freedom);
  const double z3 = z * z * z;
  const double z5 = z3 * z * z;
  const double z7 = z5 * z * z;
  return z + (z3 + z) / (4.0 * n) + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * n * n) +
         (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * n * n * n);
}

double chanceBeyond(double normal_quantile) {
  return std::erfc(normal_quantile / std::sqrt(2.0));
}

double normalQuantileOf(double chance) {
  double low = 0.0;
  double high = 38.0;  // beyond it no chance is left in a double
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (chanceBeyond(middle) > chance ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace tread::gap
