// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/se2.hpp"

namespace tread {

/// A polygon that the robot stays in, or keeps out of.
struct Fence {
  static constexpr size_t kMostCorners = 64;
  static constexpr double kFarthest = 1e5;  ///< [m] of a corner from the origin of map

  std::string name;
  bool keep_out = false;                 ///< false: stay in
  std::vector<Eigen::Vector2d> corners;  ///< p_map [m], in turn; the last one joins the first
};

inline bool operator==(const Fence& a, const Fence& b) {
  return a.name == b.name && a.keep_out == b.keep_out && a.corners == b.corners;
}

/// What is wrong with a fence, in words; empty = nothing.
std::string faultOf(const Fence& fence);

/// Room between a robot, or a point, and the nearest ground that a fence forbids.
struct FenceRoom {
  double metres;        ///< [m] negative: so far over the fence; infinite without fences
  std::string nearest;  ///< name of that fence
};

/// [m] from a point to the ground that a fence forbids; negative: inside of it, so far from its
/// edge.
double roomAt(const Fence& fence, const Eigen::Vector2d& p_map);

/// [m] by which an outline at a pose is over a fence; 0 = not at all.
/** How far its farthest corner is over it, or how deep the fence's border or ground reaches into
 * the outline, whichever is more. Where the fence cuts the outline in two, as a ditch does that is
 * narrower than the robot: by how much the body's origin is nearer to it than the reach of the
 * outline. Where the outline lies wholly beyond: the distance of the origin and that reach. Coming
 * back, and leaving a ditch to either side, always makes it less. */
double depthOver(const Fence& fence, const Pose2& T_map_body, const FootprintSize& outline);

/// The room of an outline at a pose: the gap to the fence, or minus depthOver. Far from the fence
/// it is a lower bound.
double roomAt(const Fence& fence, const Pose2& T_map_body, const FootprintSize& outline);

/// The least of all fences.
FenceRoom roomAt(const std::vector<Fence>& fences, const Eigen::Vector2d& p_map);
FenceRoom roomAt(const std::vector<Fence>& fences, const Pose2& T_map_body,
                 const FootprintSize& outline);

/// [m] from the body's origin to the farthest corner of an outline.
double reachOf(const FootprintSize& outline);

/// [m] by which a position may be off whose standard deviation is given; NaN = unknown.
double positionMargin(double std);

}  // namespace tread
