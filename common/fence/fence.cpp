// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/fence/fence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tread {
namespace {

using Eigen::Vector2d;

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

const Vector2d& nextCorner(const Fence& fence, size_t i) {
  return fence.corners[i + 1 == fence.corners.size() ? 0 : i + 1];
}

double distanceToEdge(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d ab = b - a;
  const double square = ab.squaredNorm();
  const double share = square > 0.0 ? std::clamp((p - a).dot(ab) / square, 0.0, 1.0) : 0.0;
  return (p - a - share * ab).norm();
}

/// Even-odd rule.
bool isInside(const Fence& fence, const Vector2d& p) {
  bool inside = false;
  for (size_t i = 0; i < fence.corners.size(); ++i) {
    const Vector2d& a = fence.corners[i];
    const Vector2d& b = nextCorner(fence, i);
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x()) inside = !inside;
  }
  return inside;
}

double distanceToBorder(const Fence& fence, const Vector2d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < fence.corners.size(); ++i)
    least = std::min(least, distanceToEdge(p, fence.corners[i], nextCorner(fence, i)));
  return least;
}

bool edgesCross(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const double c_side = cross(b - a, c - a), d_side = cross(b - a, d - a);
  const double a_side = cross(d - c, a - c), b_side = cross(d - c, b - c);
  return (c_side > 0.0) != (d_side > 0.0) && (a_side > 0.0) != (b_side > 0.0);
}

/// The outline's corners in turn.
std::array<Vector2d, 4> cornersOf(const FootprintSize& outline) {
  return {Vector2d(outline.front, outline.half_width), Vector2d(-outline.rear, outline.half_width),
          Vector2d(-outline.rear, -outline.half_width),
          Vector2d(outline.front, -outline.half_width)};
}

/// How deep a point of the body's frame lies in the outline [m]; negative outside.
double depthIn(const FootprintSize& outline, const Vector2d& p) {
  return std::min(
      {outline.front - p.x(), p.x() + outline.rear, outline.half_width - std::abs(p.y())});
}

/// Least distance between the border of a fence and that of an outline that it does not cross.
double gapBetween(const Fence& fence, const std::array<Vector2d, 4>& box) {
  double gap = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < 4; ++i) {
    gap = std::min(gap, distanceToBorder(fence, box[i]));
    for (const Vector2d& corner : fence.corners)
      gap = std::min(gap, distanceToEdge(corner, box[i], box[(i + 1) % 4]));
  }
  return gap;
}

bool bordersCross(const Fence& fence, const std::array<Vector2d, 4>& box) {
  for (size_t i = 0; i < fence.corners.size(); ++i)
    for (size_t k = 0; k < 4; ++k)
      if (edgesCross(fence.corners[i], nextCorner(fence, i), box[k], box[(k + 1) % 4])) return true;
  return false;
}

double reachOf(const FootprintSize& outline) {
  return std::hypot(std::max(outline.front, outline.rear), outline.half_width);
}

}  // namespace

std::string faultOf(const Fence& fence) {
  const size_t count = fence.corners.size();
  if (fence.name.empty() || fence.name.size() > 32) return "its name needs 1 to 32 characters";
  if (count < 3 || count > Fence::kMostCorners) return "a fence needs 3 to 64 corners";
  for (const Vector2d& corner : fence.corners)
    if (!(corner.cwiseAbs().maxCoeff() < Fence::kFarthest) || !corner.allFinite())
      return "a corner is no place in map";
  double area = 0.0;
  for (size_t i = 0; i < count; ++i) area += cross(fence.corners[i], nextCorner(fence, i)) / 2.0;
  if (std::abs(area) < 1e-3) return "its corners enclose nothing";
  for (size_t i = 0; i < count; ++i)
    for (size_t k = i + 2; k < count; ++k) {
      const bool neighbours = i == 0 && k + 1 == count;
      if (!neighbours && edgesCross(fence.corners[i], nextCorner(fence, i), fence.corners[k],
                                    nextCorner(fence, k)))
        return "it crosses itself: give its corners in turn";
    }
  return "";
}

double roomAt(const Fence& fence, const Vector2d& p_map) {
  const double distance = distanceToBorder(fence, p_map);
  return isInside(fence, p_map) == fence.keep_out ? -distance : distance;
}

double roomAt(const Fence& fence, const Pose2& T_map_body, const FootprintSize& outline) {
  const double reach = reachOf(outline);
  const double of_origin = roomAt(fence, T_map_body.position());
  if (of_origin > 3.0 * reach) return of_origin - reach;
  std::array<Vector2d, 4> box = cornersOf(outline);
  for (Vector2d& corner : box) corner = T_map_body * corner;
  double deepest = -1.0;
  for (const Vector2d& corner : box) deepest = std::max(deepest, -roomAt(fence, corner));
  const Pose2 T_body_map = inverse(T_map_body);
  bool within = false;  // a corner of the fence under the body
  for (const Vector2d& corner : fence.corners) {
    const double depth = depthIn(outline, T_body_map * corner);
    within = within || depth > 0.0;
    deepest = std::max(deepest, depth);
  }
  if (within || bordersCross(fence, box)) return -std::max(deepest, 0.0);
  return of_origin < 0.0 ? of_origin - reach : gapBetween(fence, box);
}

FenceRoom roomAt(const std::vector<Fence>& fences, const Pose2& T_map_body,
                 const FootprintSize& outline) {
  FenceRoom least{std::numeric_limits<double>::infinity(), ""};
  for (const Fence& fence : fences) {
    const double room = roomAt(fence, T_map_body, outline);
    if (room < least.metres) least = {room, fence.name};
  }
  return least;
}

}  // namespace tread
