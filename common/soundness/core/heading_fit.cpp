// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/soundness/core/heading_fit.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "common/soundness/core/command_check.hpp"

namespace tread::gap {
namespace {

/// [m] whose direction exceeds the noise; the second for slower motion.
constexpr double kLeastWay[] = {0.1, 0.03};

HeadingFit fitHeading(const std::vector<PoseIncrement>& increments, double factor,
                      double least_way) {
  std::complex<double> sum;
  double weight = 0.0;
  HeadingFit fit;
  fit.factor = factor;
  for (const PoseIncrement& increment : increments) {
    const double turn = std::abs(factor * increment.T_begin_end.yaw);
    const double length = way(increment);
    if (!(length > least_way) || !(length < 1e3) || turn > kGentle || length < kLever * turn)
      continue;
    sum += length * std::polar(1.0, 2.0 * (course(increment) - heading(increment, factor)));
    weight += length;
    ++fit.legs;
  }
  if (fit.legs < kFewestLegs) return fit;
  fit.coherence = std::abs(sum) / weight;
  fit.offset = 0.5 * std::arg(sum);
  return fit;
}

}  // namespace

double course(const PoseIncrement& increment) {
  return increment.from.yaw + std::atan2(increment.T_begin_end.y, increment.T_begin_end.x);
}

double way(const PoseIncrement& increment) {
  return std::hypot(increment.T_begin_end.x, increment.T_begin_end.y);
}

double heading(const PoseIncrement& increment, double factor) {
  return factor * (increment.from.yaw + 0.5 * increment.T_begin_end.yaw);
}

bool isTurned(const HeadingFit& fit) {
  return fit.coherence > kTogether && std::abs(fit.offset) > kPi / 4.0;
}

HeadingFit bestHeading(const std::vector<PoseIncrement>& increments) {
  HeadingFit itself;
  double least_way = 0.0;
  for (const double least : kLeastWay)
    if (itself.legs < kFewestLegs) itself = fitHeading(increments, 1.0, least_way = least);
  HeadingFit best = itself;
  for (const double factor : {-1.0, kDegree, 1.0 / kDegree}) {
    const HeadingFit fit = fitHeading(increments, factor, least_way);
    if (fit.coherence > std::max(kTogether, best.coherence)) best = fit;
  }
  return itself.coherence < kNotTogether && best.coherence > kTogether ? best : itself;
}

}  // namespace tread::gap
