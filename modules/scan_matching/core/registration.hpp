// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include <Eigen/Core>

#include "common/geometry/se2.hpp"
#include "modules/scan_matching/core/local_map.hpp"
#include "modules/scan_matching/core/scan_points.hpp"

namespace tread::scan_matching {

/// Where the body is thought to be before a scan is matched.
struct PosePrior {
  Pose2 T_map_body;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of x, y, yaw in map [m, rad]
};

/// What a scan says about the pose from which it was taken.
struct Registration {
  Pose2 T_map_body;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< (3x3) of the scan alone: x, y, yaw
  int undetermined = 0;  ///< directions, of three, about which the scan says nothing
  int matched = 0;       ///< points that have a partner in the map
  double overlap = 0.0;  ///< their share of all points
  double misfit = 1.0;   ///< 0 = every point lies on the map, 1 = none does
  double noise = 0.0;    ///< [m] standard deviation of the distances to the lines of the map
};

/// How scans are laid onto the map.
struct RegistrationConfig {
  double range_noise = 0.01;    ///< [m] standard deviation of a single range
  double surface_noise = 0.01;  ///< [m] least error that the points of one thing share
  double ground_noise = 0.3;    ///< [m] the same of what may be the ground
};

/// Lays a scan onto the map, beginning at a pose: iterative closest point with distances to lines.
/** Source: Chen and Medioni 1992 (distance to the tangent), Censi 2008 (PLICP, in the plane);
 *  1. Each point takes the nearest point of the map as its partner. To a line only the distance
 *     counts, to a scatter the whole offset, with a weight that its own spread allows. Weights fall
 *     with the residual (Cauchy), the scale is the residuals' own.
 *  2. Gauss-Newton on x, y, yaw with `prior` beside the scan.
 *  3. What the lines say of the direction along them is the noise of their normals. With H what the
 *     scan tells and F what that noise alone would tell, the directions with H v = m F v and small
 *     m are undetermined: there the prior alone counts. From the others F is taken off.
 *  4. What stands in the map is not the same from everywhere (leaves, a slope, the map's own
 * error): the points of 2 m of one thing share an error that their number does not make smaller. It
 *     is told by how far such pieces as a whole lie off.
 *  5. What both the scan and the map saw only from afar may be the ground, which a level beam meets
 *     where that rises: such pieces tell no more than `ground_noise` allows. */
Registration registerScan(const std::vector<ScanPoint>& points, const LocalMap& map,
                          const Pose2& start, const PosePrior& prior,
                          const Eigen::Vector2d& p_body_sensor, const RegistrationConfig& config);

/// The pose at which most returns lie on something of the map, within a window around the prior of
/// 2.5 standard deviations, at most 1.5 m and 0.6 rad.
/** Source: Olson 2009, correlative scan matching, in two resolutions. */
Pose2 searchPose(const std::vector<ScanPoint>& points, const LocalMap& map, const PosePrior& prior);

}  // namespace tread::scan_matching
