// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/se2.hpp"

namespace tread {

/// A polygon that the robot must stay in or keep out of.
struct Fence {
  static constexpr size_t kMostCorners = 64;
  /// [m] largest distance of a corner from the origin of map
  static constexpr double kFarthest = 1e5;

  std::string name;
  bool keep_out = false;  ///< false: stay in
  /// p_map [m], in order; the last one is joined to the first
  std::vector<Eigen::Vector2d> corners;
};

inline bool operator==(const Fence& a, const Fence& b) {
  return a.name == b.name && a.keep_out == b.keep_out && a.corners == b.corners;
}

/// What is wrong with a fence, in words; empty = valid.
std::string faultOf(const Fence& fence);

/// Clearance between a robot or a point and the nearest ground that a fence forbids.
struct FenceRoom {
  double metres;        ///< [m] negative: depth beyond the fence; infinite without fences
  std::string nearest;  ///< name of that fence
};

/// [m] from a point to the ground that a fence forbids; negative inside of it: distance to its
/// edge.
double roomAt(const Fence& fence, const Eigen::Vector2d& p_map);

/// [m] by which an outline at a pose is over a fence; 0 = not at all.
/** Depth of its farthest corner beyond the fence, or depth to which the fence's border or ground
 * reaches into the outline, whichever is larger. Where the fence cuts the outline in two, like a
 * ditch narrower than the robot: reach of the outline minus distance of the body's origin from the
 * fence. Where the outline lies wholly beyond: distance of the origin plus that reach. Driving
 * back, or off a ditch to either side, always reduces it. */
double depthOver(const Fence& fence, const Pose2& T_map_body, const FootprintSize& outline);

/// Clearance of an outline at a pose: the gap to the fence, or -depthOver(). Far from the fence it
/// is a lower bound.
double roomAt(const Fence& fence, const Pose2& T_map_body, const FootprintSize& outline);

/// The smallest over all fences.
FenceRoom roomAt(const std::vector<Fence>& fences, const Eigen::Vector2d& p_map);
FenceRoom roomAt(const std::vector<Fence>& fences, const Pose2& T_map_body,
                 const FootprintSize& outline);

/// [m] from the body's origin to the farthest corner of an outline.
double reachOf(const FootprintSize& outline);

/// [m] position error to allow for, given the standard deviation; NaN = unknown.
double positionMargin(double std);

}  // namespace tread
