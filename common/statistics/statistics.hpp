// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace tread {

/// What a figure of no values is, unless the caller names another one.
inline constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();

/// The value that has `rank` values below it when they are sorted; there must be more than `rank`.
template <typename Value>
Value valueAtRank(std::vector<Value> values, size_t rank) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// A value of the series with half of them below it: of an even number the upper one of two.
template <typename Value>
Value upperMedian(std::vector<Value> values, Value of_none = {}) {
  const size_t middle = values.size() / 2;
  return values.empty() ? of_none : valueAtRank(std::move(values), middle);
}

/// The median: of an even number the mean of the two in the middle.
inline double medianOf(std::vector<double> values, double of_none = kNoFigure) {
  if (values.empty()) return of_none;
  std::sort(values.begin(), values.end());
  const size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2.0;
}

/// The value that a share of the others does not exceed: that of the nearest rank.
inline double quantileOf(std::vector<double> values, double share, double of_none = kNoFigure) {
  if (values.empty()) return of_none;
  const double rank = share * static_cast<double>(values.size() - 1);
  return valueAtRank(std::move(values), static_cast<size_t>(rank + 0.5));
}

/// The same, of the rank below.
inline double lowerQuantile(std::vector<double> values, double share, double of_none = kNoFigure) {
  if (values.empty()) return of_none;
  const double rank = share * static_cast<double>(values.size() - 1);
  return valueAtRank(std::move(values), static_cast<size_t>(rank));
}

inline double meanOf(const std::vector<double>& values, double of_none = kNoFigure) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? of_none : sum / static_cast<double>(values.size());
}

/// Root of the mean square.
inline double rmsOf(const std::vector<double>& values, double of_none = kNoFigure) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return values.empty() ? of_none : std::sqrt(sum / static_cast<double>(values.size()));
}

/// A value with the limits between which it is with 95 %.
struct ConfidenceInterval {
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;

  bool holds(double truth) const { return low <= truth && truth <= high; }
};

/// Of a quantity that was not measured.
inline constexpr ConfidenceInterval kNoInterval{kNoFigure, kNoFigure, kNoFigure};

}  // namespace tread
