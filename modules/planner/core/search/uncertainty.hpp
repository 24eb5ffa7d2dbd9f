// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cmath>

#include "common/pattern/pattern.hpp"

namespace tread::planner {

/// Covariance of a planar pose, upper triangle [m2, m rad, rad2]; all 0 = certain.
struct Uncertainty {
  float xx = 0.0F, xy = 0.0F, xyaw = 0.0F;
  float yy = 0.0F, yyaw = 0.0F;
  float yawyaw = 0.0F;

  /// Larger variance of the position, in whatever direction it is [m2].
  float position() const {
    const float half = 0.5F * (xx - yy);
    return 0.5F * (xx + yy) + std::sqrt(half * half + xy * xy);
  }
  /// Variance of a point `arm` [m] away from the origin, at most [m2].
  /** The sum of two standard deviations is the standard deviation of fully correlated errors. */
  float ofPoint(float arm) const {
    const float sigma = std::sqrt(position()) + arm * std::sqrt(yawyaw);
    return sigma * sigma;
  }
};

/// A covariance as sets carry it; `otherwise` where it is unknown (NaN).
inline Uncertainty uncertaintyOf(const PoseCovariance& c, const Uncertainty& otherwise) {
  for (const double value : c)
    if (!std::isfinite(value)) return otherwise;
  Uncertainty result;
  result.xx = std::max(0.0F, static_cast<float>(c[0]));
  result.xy = static_cast<float>(c[1]);
  result.xyaw = static_cast<float>(c[2]);
  result.yy = std::max(0.0F, static_cast<float>(c[3]));
  result.yyaw = static_cast<float>(c[4]);
  result.yawyaw = std::max(0.0F, static_cast<float>(c[5]));
  return result;
}

/// Uncertainty, in map, of T_map_b * T_b_c with independent errors.
/** `at` belongs to T_map_b and is in map axes; `step` to T_b_c, in the axes of b; (dx, dy) is
 * T_b_c's translation in map axes [m], (c, s) are cosine and sine of b's yaw. First order: P' = F P
 * F' + G Q G' with F = [1 0 -dy; 0 1 dx; 0 0 1] and G = rotation by b's yaw. */
inline Uncertainty compose(const Uncertainty& at, const Uncertainty& step, float dx, float dy,
                           float c, float s) {
  Uncertainty r;
  r.yawyaw = at.yawyaw + step.yawyaw;
  r.xyaw = at.xyaw - dy * at.yawyaw + c * step.xyaw - s * step.yyaw;
  r.yyaw = at.yyaw + dx * at.yawyaw + s * step.xyaw + c * step.yyaw;
  r.xx = at.xx - 2.0F * dy * at.xyaw + dy * dy * at.yawyaw + c * c * step.xx -
         2.0F * c * s * step.xy + s * s * step.yy;
  r.yy = at.yy + 2.0F * dx * at.yyaw + dx * dx * at.yawyaw + s * s * step.xx +
         2.0F * c * s * step.xy + c * c * step.yy;
  r.xy = at.xy + dx * at.xyaw - dy * at.yyaw - dx * dy * at.yawyaw + c * s * (step.xx - step.yy) +
         (c * c - s * s) * step.xy;
  return r;
}

/// A share [1] of an uncertainty, in axes that lie turned by a yaw [rad].
inline Uncertainty scaled(const Uncertainty& u, double share, double yaw) {
  const auto k = static_cast<float>(share);
  const Uncertainty part{k * u.xx, k * u.xy, k * u.xyaw, k * u.yy, k * u.yyaw, k * u.yawyaw};
  return compose({}, part, 0.0F, 0.0F, static_cast<float>(std::cos(yaw)),
                 static_cast<float>(std::sin(yaw)));
}

}  // namespace tread::planner
