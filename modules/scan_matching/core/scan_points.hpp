// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include <Eigen/Core>

#include "common/geometry/beam.hpp"
#include "common/geometry/se2.hpp"

namespace tread::scan_matching {

/// A return seen from above.
struct PlanarReturn {
  Eigen::Vector2d p_body = Eigen::Vector2d::Zero();  ///< where the body was at its own time [m]
  double share = 0.0;  ///< 0 = at the time of the first beam, 1 = of the last
};

/// What a point of a scan is part of.
enum class Shape {
  kLine,    ///< something straight: tells the distance to it, and nothing of the way along it
  kScatter  ///< leaves, posts, corners: tells where it is, less well
};

/// A point of a scan, a mean of returns that lie side by side, with what lies around it.
struct ScanPoint {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();       ///< [m] p_body, in the middle of the sweep
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();  ///< unit, towards the range finder; of lines
  double spread = 0.0;                               ///< [m] to the nearest other point of its scan
  double normal_variance = 0.0;                      ///< of its direction [rad2]
  Shape shape = Shape::kScatter;
  bool doubtful = false;  ///< may be the ground: it moves as the robot tilts
};

/// How returns become points.
struct ScanPointsConfig {
  double range_noise = 0.01;  ///< [m] standard deviation of a single range
  double spacing = 0.05;      ///< [m] returns that lie closer together become one point
  double range_max = 30.0;    ///< [m] what is farther away is not matched
};

/// Brings the returns of a sweep to where they lie as seen from the body in the middle of it, and
/// says what they are part of.
/** 1. Each return is moved by what the body, with a constant twist, moved between its own beam and
 *     the middle: there a wrong twist does least.
 *  2. Neighbours in the order of the beams within `spacing` become their mean.
 *  3. A line is fitted to each point and its neighbours in the same order; where they lie on one,
 *     the point is of a line, where there are many and they do not, of a scatter. Single points
 *     are left out: what they are part of is not known.
 *  `p_body_sensor` [m]: normals point to it. `duration` [s]: from the first to the last beam. */
std::vector<ScanPoint> scanPoints(const std::vector<PlanarReturn>& returns,
                                  const Eigen::Vector2d& p_body_sensor, const Twist2& twist,
                                  double duration, const ScanPointsConfig& config);

}  // namespace tread::scan_matching
