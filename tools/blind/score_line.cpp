// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>

#include "tools/blind/scores.hpp"

namespace tread::blindtest {

std::optional<bool> ScoreLine::met() const {
  if (!must || cases == 0) return std::nullopt;
  bool good = must->least ? value >= must->at : value <= must->at;
  if (must->below) good = good && value <= *must->below;
  if (must->upper_end) good = good && high <= *must->upper_end;
  return good;
}

void setShare(ScoreLine& line) {
  if (line.cases == 0) return;
  constexpr double z = 1.959963985;
  const auto n = static_cast<double>(line.cases);
  const double p = static_cast<double>(line.hits) / n;
  const double centre = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
  const double half = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n)) / (1.0 + z * z / n);
  line.value = p;
  line.low = std::max(0.0, centre - half);
  line.high = std::min(1.0, centre + half);
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return kUnknown;
  std::sort(values.begin(), values.end());
  const double at = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<size_t>(at);
  const size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace tread::blindtest
