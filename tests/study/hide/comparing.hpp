// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>

#include "tests/study/hide/hider.hpp"

namespace tread::blind {

/// A quantity that is known by construction.
inline Quantity built(const char* name, double value, const char* unit) {
  return {name, value, unit, false};
}

using PairValue = std::function<double(const SteadyPair&)>;

/// Least-squares k of y = k x; 0 if x is always 0.
inline double slopeOf(const Comparison& comparison, const PairValue& x, const PairValue& y) {
  double xx = 0.0, xy = 0.0;
  for (const SteadyPair& pair : comparison.pairs) {
    xx += x(pair) * x(pair);
    xy += x(pair) * y(pair);
  }
  return xx > 0.0 ? xy / xx : 0.0;
}

/// Mean of y where `where` is above 0; 0 if it never is.
inline double meanWhere(const Comparison& comparison, const PairValue& where, const PairValue& y) {
  double sum = 0.0;
  int count = 0;
  for (const SteadyPair& pair : comparison.pairs) {
    if (where(pair) <= 0.0) continue;
    sum += y(pair);
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

/// One quantity measured by slopeOf.
inline std::function<std::vector<Quantity>(const Comparison&)> fitted(const char* name,
                                                                      const char* unit, PairValue x,
                                                                      PairValue y) {
  return [=](const Comparison& comparison) {
    return std::vector<Quantity>{{name, slopeOf(comparison, x, y), unit, true}};
  };
}

}  // namespace tread::blind
