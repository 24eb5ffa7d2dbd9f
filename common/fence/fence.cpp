// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/fence/fence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace tread {
namespace {

using Eigen::Vector2d;

constexpr double kTouch = 1e-9;  // [m] less is rounding: touching is not crossing

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

/// A part of the fence's border under an outline, in the body's frame.
struct Piece {
  Vector2d a, b;
  double depth = 0.0;  ///< [m] of its deepest point in the outline
  int ends = 0;        ///< how many of its ends lie on the outline's border
};

/// Largest depth in the outline of an edge from `a` to `b` between two shares of its length: the
/// minimum of four straight lines has its maximum where two of them meet, or at an end.
double deepestBetween(const std::array<double, 4>& a, const std::array<double, 4>& b, double from,
                      double until) {
  const auto depthAt = [&](double share) {
    double least = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < 4; ++i) least = std::min(least, a[i] + share * (b[i] - a[i]));
    return least;
  };
  double deepest = std::max(depthAt(from), depthAt(until));
  for (size_t i = 0; i < 4; ++i)
    for (size_t k = i + 1; k < 4; ++k) {
      const double share = (a[k] - a[i]) / ((b[i] - a[i]) - (b[k] - a[k]));
      if (share > from && share < until) deepest = std::max(deepest, depthAt(share));
    }
  return deepest;
}

/// The part of an edge under the outline; depth 0 if there is none.
Piece pieceUnder(const FootprintSize& outline, const Vector2d& a, const Vector2d& b) {
  const auto depths = [&](const Vector2d& p) -> std::array<double, 4> {
    return {outline.front - p.x(), p.x() + outline.rear, outline.half_width - p.y(),
            p.y() + outline.half_width};
  };
  const std::array<double, 4> at_a = depths(a), at_b = depths(b);
  double from = 0.0, until = 1.0;
  for (size_t i = 0; i < 4; ++i) {
    if (at_a[i] <= kTouch && at_b[i] <= kTouch) return {};
    if (at_a[i] < 0.0) from = std::max(from, at_a[i] / (at_a[i] - at_b[i]));
    if (at_b[i] < 0.0) until = std::min(until, at_a[i] / (at_a[i] - at_b[i]));
  }
  if (from >= until) return {};
  const double depth = deepestBetween(at_a, at_b, from, until);
  if (depth <= kTouch) return {};
  return {a + from * (b - a), a + until * (b - a), depth,
          (from > 0.0 ? 1 : 0) + (until < 1.0 ? 1 : 0)};
}

/// All parts of the border under an outline.
std::vector<Piece> borderUnder(const Fence& fence, const Pose2& T_map_body,
                               const FootprintSize& outline) {
  const Eigen::Rotation2Dd R_body_map(-T_map_body.yaw);
  const Eigen::Matrix2d turn = R_body_map.toRotationMatrix();
  const Vector2d origin = T_map_body.position();
  std::vector<Piece> pieces;
  Vector2d a = turn * (fence.corners.back() - origin);
  for (const Vector2d& corner : fence.corners) {
    const Vector2d b = turn * (corner - origin);
    const Piece piece = pieceUnder(outline, a, b);
    if (piece.depth > 0.0) pieces.push_back(piece);
    a = b;
  }
  return pieces;
}

bool forbids(const Fence& fence, const Vector2d& p_map) {
  return isInside(fence, p_map) == fence.keep_out;
}

bool isPrintable(const std::string& name) {
  return std::all_of(name.begin(), name.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

}  // namespace

std::string faultOf(const Fence& fence) {
  const size_t count = fence.corners.size();
  // It is shown in terminals and in stop reasons.
  if (fence.name.empty() || fence.name.size() > 32 || !isPrintable(fence.name))
    return "its name needs 1 to 32 printable ASCII characters";
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

double reachOf(const FootprintSize& outline) {
  return std::hypot(std::max(outline.front, outline.rear), outline.half_width);
}

double positionMargin(double std) {
  constexpr double kSigmas = 2.0;
  constexpr double kUnknown = 0.2;  // [m]
  return std::isfinite(std) ? kSigmas * std : kUnknown;
}

double roomAt(const Fence& fence, const Vector2d& p_map) {
  const double distance = distanceToBorder(fence, p_map);
  return forbids(fence, p_map) ? -distance : distance;
}

double depthOver(const Fence& fence, const Pose2& T_map_body, const FootprintSize& outline) {
  const Vector2d origin = T_map_body.position();
  const std::vector<Piece> pieces = borderUnder(fence, T_map_body, outline);
  if (pieces.empty())
    return forbids(fence, origin) ? reachOf(outline) + distanceToBorder(fence, origin) : 0.0;
  // Upper bound of the depth: the border is at most as far from the origin as roomAt() returns.
  const double most = reachOf(outline) - roomAt(fence, origin);
  double deepest = 0.0;
  int ends = 0;
  for (const Piece& piece : pieces) {
    deepest = std::max(deepest, piece.depth);
    ends += piece.ends;
  }
  if (ends > 2) return most;
  for (const Vector2d& corner : cornersOf(outline.widened(-kTouch))) {
    if (!forbids(fence, T_map_body * corner)) continue;
    double nearest = most;
    for (const Piece& piece : pieces)
      nearest = std::min(nearest, distanceToEdge(corner, piece.a, piece.b));
    deepest = std::max(deepest, nearest);
  }
  const Vector2d middle(0.5 * (outline.front - outline.rear), 0.0);
  if (forbids(fence, T_map_body * middle))
    deepest = std::max(deepest, std::min(outline.half_width, 0.5 * outline.length()));
  return deepest;
}

double roomAt(const Fence& fence, const Pose2& T_map_body, const FootprintSize& outline) {
  const double reach = reachOf(outline);
  const double of_origin = roomAt(fence, T_map_body.position());
  if (of_origin > 3.0 * reach) return of_origin - reach;
  const double depth = depthOver(fence, T_map_body, outline);
  if (depth > 0.0) return -depth;
  std::array<Vector2d, 4> box = cornersOf(outline);
  for (Vector2d& corner : box) corner = T_map_body * corner;
  return gapBetween(fence, box);
}

namespace {

template <class... Where>
FenceRoom leastRoom(const std::vector<Fence>& fences, const Where&... where) {
  FenceRoom least{std::numeric_limits<double>::infinity(), ""};
  for (const Fence& fence : fences) {
    const double room = roomAt(fence, where...);
    if (room < least.metres) least = {room, fence.name};
  }
  return least;
}

}  // namespace

FenceRoom roomAt(const std::vector<Fence>& fences, const Vector2d& p_map) {
  return leastRoom(fences, p_map);
}

FenceRoom roomAt(const std::vector<Fence>& fences, const Pose2& T_map_body,
                 const FootprintSize& outline) {
  return leastRoom(fences, T_map_body, outline);
}

}  // namespace tread
