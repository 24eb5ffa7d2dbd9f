// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include <Eigen/Core>

#include "common/geometry/se2.hpp"
#include "modules/scan_matching/core/local_map.hpp"
#include "modules/scan_matching/core/scan_points.hpp"

namespace tread::scan_matching {

/// Expected pose of the body before a scan is matched.
struct PosePrior {
  Pose2 T_map_body;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of x, y, yaw in map [m, rad]
};

/// A scan's information about the pose from which it was taken.
struct Registration {
  Pose2 T_map_body;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< (3x3) of the scan alone: x, y, yaw
  int undetermined = 0;  ///< number of the three directions about which the scan has no information
  int matched = 0;       ///< points with a partner in the map
  double overlap = 0.0;  ///< their share of all points
  double misfit = 1.0;   ///< 0 = every point is on the map, 1 = none is
  double noise = 0.0;    ///< [m] standard deviation of the distances to the lines of the map
};

/// Settings of scan registration.
struct RegistrationConfig {
  double range_noise = 0.01;    ///< [m] standard deviation of a single range
  double surface_noise = 0.01;  ///< [m] lower limit of the common error of points on one object
  double ground_noise = 0.3;    ///< [m] the same for points that may be ground
};

/// Aligns a scan with the map, starting at a pose: iterative closest point with point-to-line
/// distances.
/** Source: Chen and Medioni 1992 (distance to the tangent), Censi 2008 (PLICP, in the plane);
 *  1. Each point takes the nearest point of the map as its partner. For a line only the distance
 *     counts, for scatter the whole offset, weighted by its own spread. Weights fall with the
 *     residual (Cauchy), with the residuals' own scale.
 *  2. Gauss-Newton on x, y, yaw, combined with `prior`.
 *  3. A line's apparent information along its direction is noise of its normals. With H the scan's
 *     information and F the part that this noise alone would give, directions with H v = m F v and
 *     small m are undetermined: there only the prior counts. From the others F is subtracted.
 *  4. Objects in the map look different from different positions (leaves, a slope, the map's own
 *     error): the points of one object within 2 m share an error that their number does not
 *     reduce. It is estimated from the mean offsets of such pieces.
 *  5. Points that both scan and map saw only from afar may be ground, which a level beam hits
 *     where it rises: such pieces are weighted with `ground_noise`. */
Registration registerScan(const std::vector<ScanPoint>& points, const LocalMap& map,
                          const Pose2& start, const PosePrior& prior,
                          const Eigen::Vector2d& p_body_sensor, const RegistrationConfig& config);

}  // namespace tread::scan_matching
