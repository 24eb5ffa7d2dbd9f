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

/// The same for an outline at a pose. Where the outline crosses the fence, how far its farthest
/// corner is over it; where it lies wholly beyond, the distance of the body's origin and the reach
/// of the outline: coming back always makes it more. Far from the
/// fence it is a lower bound.
double roomAt(const Fence& fence, const Pose2& T_map_body, const FootprintSize& outline);

/// The least of all fences.
FenceRoom roomAt(const std::vector<Fence>& fences, const Pose2& T_map_body,
                 const FootprintSize& outline);

}  // namespace tread
