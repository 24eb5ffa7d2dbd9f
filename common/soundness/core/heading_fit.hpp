// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "common/soundness/core/log_validation.hpp"

namespace tread::gap {

inline constexpr double kDegree = kPi / 180.0;  // [rad]
/// Coherence of course and heading above which they agree, and below which they do not.
inline constexpr double kTogether = 0.85;
inline constexpr double kNotTogether = 0.6;
inline constexpr size_t kFewestLegs = 20;

/// Direction of an increment in the map [rad], and its length [m].
double course(const PoseIncrement& increment);
double way(const PoseIncrement& increment);
/// The heading in the middle of an increment, times a factor [rad].
double heading(const PoseIncrement& increment, double factor);

/// Agreement of the course with a heading that is multiplied by a factor.
struct HeadingFit {
  double factor = 1.0;
  double coherence = 0.0;  ///< 0..1
  double offset = 0.0;     ///< [rad] of the course from the heading, within a quarter turn
  size_t legs = 0;
};

/// Whether they agree except for a constant offset.
bool isTurned(const HeadingFit& fit);

/// The reading of the heading that agrees with the course: unchanged, mirrored, in degrees or in
/// radians.
/** Unchanged unless another reading agrees clearly better. */
HeadingFit bestHeading(const std::vector<PoseIncrement>& increments);

}  // namespace tread::gap
