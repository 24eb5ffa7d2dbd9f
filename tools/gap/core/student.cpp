// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/core/student.hpp"

#include <algorithm>

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

}  // namespace tread::gap
