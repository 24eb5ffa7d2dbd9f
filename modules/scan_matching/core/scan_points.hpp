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

/// Shape to which a point of a scan belongs.
enum class Shape {
  kLine,    ///< a straight line: determines the distance from it, but not the position along it
  kScatter  ///< leaves, posts, corners: determine a position, less accurately
};

/// A point of a scan, the mean of adjacent returns, with its local shape.
struct ScanPoint {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();       ///< [m] p_body, in the middle of the sweep
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();  ///< unit, towards the range finder; of lines
  double spread = 0.0;                               ///< [m] to the nearest other point of its scan
  double normal_variance = 0.0;                      ///< of its direction [rad2]
  Shape shape = Shape::kScatter;
  bool doubtful = false;  ///< may be ground: it moves as the robot tilts
};

/// How returns are combined to points.
struct ScanPointsConfig {
  double range_noise = 0.01;  ///< [m] standard deviation of a single range
  double spacing = 0.05;      ///< [m] returns closer together become one point
  double range_max = 30.0;    ///< [m] more distant returns are not matched
};

/// Transforms the returns of a sweep to their positions relative to the body in the middle of it,
/// and classifies them by shape.
/** 1. Each return is moved by the body's motion, at constant twist, between its own beam and the
 *    middle, where an error of the twist has the least effect.
 *  2. Consecutive returns within `spacing` become their mean.
 *  3. A line is fitted to each point and its neighbours in the same order; if they are on it, the
 *     point belongs to a line; if there are many and they are not, to scatter. Single points are
 *     left out, because their shape is unknown.
 * `p_body_sensor` [m]: normals point to it. `duration` [s]: from the first to the last beam. */
std::vector<ScanPoint> scanPoints(const std::vector<PlanarReturn>& returns,
                                  const Eigen::Vector2d& p_body_sensor, const Twist2& twist,
                                  double duration, const ScanPointsConfig& config);

}  // namespace tread::scan_matching
