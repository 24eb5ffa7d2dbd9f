// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/core/obstacle.hpp"

#include <array>

namespace tread::sim {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

using Corners = std::array<Eigen::Vector2d, 4>;

Corners cornersOf(const Rectangle& rectangle, const Pose2& T_map_body) {
  const double x = rectangle.length / 2.0;
  const double y = rectangle.width / 2.0;
  return {T_map_body * Eigen::Vector2d(x, y), T_map_body * Eigen::Vector2d(-x, y),
          T_map_body * Eigen::Vector2d(-x, -y), T_map_body * Eigen::Vector2d(x, -y)};
}

/// Smallest of the corners' coordinates along an axis.
template <typename Points>
double lowest(const Points& points, const Eigen::Vector2d& axis) {
  double low = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& p : points) low = std::min(low, axis.dot(p));
  return low;
}

/// Overlap of the points with the half planes inside the edges of a counter-clockwise polygon.
template <typename Polygon, typename Points>
double overlapAcrossEdges(const Polygon& polygon, const Points& points) {
  double overlap = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    const Eigen::Vector2d outward = Eigen::Vector2d(edge.y(), -edge.x()).normalized();
    overlap = std::min(overlap, outward.dot(polygon[i]) - lowest(points, outward));
  }
  return overlap;
}

double discPenetration(const Obstacle& disc, const Rectangle& rectangle, const Pose2& T_map_body) {
  const Eigen::Vector2d centre = inverse(T_map_body) * disc.centre;
  const Eigen::Vector2d half(rectangle.length / 2.0, rectangle.width / 2.0);
  const Eigen::Vector2d outside = centre.cwiseAbs() - half;
  if (outside.maxCoeff() <= 0.0) return disc.radius - outside.maxCoeff();
  return disc.radius - outside.cwiseMax(0.0).norm();
}

std::optional<RayCrossing> discCrossing(const Obstacle& disc, const Eigen::Vector2d& start,
                                        const Eigen::Vector2d& direction) {
  const Eigen::Vector2d to_centre = disc.centre - start;
  const double along = to_centre.dot(direction);
  const double across = cross(direction, to_centre);
  const double square = disc.radius * disc.radius - across * across;
  if (square < 0.0) return std::nullopt;
  const double half = std::sqrt(square);
  if (along + half < 0.0) return std::nullopt;
  return RayCrossing{std::max(0.0, along - half), along + half};
}

std::optional<RayCrossing> polygonCrossing(const std::vector<Eigen::Vector2d>& corners,
                                           const Eigen::Vector2d& start,
                                           const Eigen::Vector2d& direction) {
  RayCrossing crossing{0.0, std::numeric_limits<double>::infinity()};
  for (size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d edge = corners[(i + 1) % corners.size()] - corners[i];
    // Inside is to the left of each edge: cross(edge, p - corner) >= 0.
    const double distance = cross(edge, start - corners[i]);
    const double rate = cross(edge, direction);
    if (rate == 0.0) {
      if (distance < 0.0) return std::nullopt;
      continue;
    }
    const double at = -distance / rate;
    if (rate > 0.0) {
      crossing.enter = std::max(crossing.enter, at);
    } else {
      crossing.leave = std::min(crossing.leave, at);
    }
    if (crossing.enter > crossing.leave) return std::nullopt;
  }
  return crossing;
}

constexpr double kMostCells = 1e6;

}  // namespace

Obstacle boxObstacle(const Pose2& T_map_box, double length, double width, double height) {
  const Corners corners = cornersOf({length, width}, T_map_box);
  Obstacle box;
  box.corners.assign(corners.begin(), corners.end());
  box.height = height;
  return box;
}

Obstacle discObstacle(const Eigen::Vector2d& centre, double radius, double height) {
  Obstacle disc;
  disc.centre = centre;
  disc.radius = radius;
  disc.height = height;
  return disc;
}

std::optional<std::string> obstacleFault(const Obstacle& obstacle) {
  if (!(obstacle.height > 0.0)) return "height must be above 0 m";
  if (obstacle.isDisc()) {
    if (!(obstacle.radius > 0.0)) return "a disc needs a radius above 0 m";
    return std::nullopt;
  }
  const auto& corners = obstacle.corners;
  if (corners.size() < 3) return "a polygon needs at least three corners";
  double turned = 0.0;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d edge = corners[(i + 1) % corners.size()] - corners[i];
    const Eigen::Vector2d next =
        corners[(i + 2) % corners.size()] - corners[(i + 1) % corners.size()];
    if (!(cross(edge, next) > 0.0)) return "corners must be convex and counter-clockwise";
    turned += std::atan2(cross(edge, next), edge.dot(next));
  }
  if (turned > 2.5 * kPi) return "the polygon's outline crosses itself";
  return std::nullopt;
}

Extent extentOf(const std::vector<Eigen::Vector2d>& corners) {
  Extent extent{corners.front(), corners.front()};
  for (const Eigen::Vector2d& corner : corners) {
    extent.low = extent.low.cwiseMin(corner);
    extent.high = extent.high.cwiseMax(corner);
  }
  return extent;
}

Extent extentOf(const Obstacle& obstacle) {
  if (!obstacle.isDisc()) return extentOf(obstacle.corners);
  const Eigen::Vector2d reach(obstacle.radius, obstacle.radius);
  return {obstacle.centre - reach, obstacle.centre + reach};
}

std::optional<RayCrossing> crossingOf(const Obstacle& obstacle, const Eigen::Vector2d& start,
                                      const Eigen::Vector2d& direction) {
  return obstacle.isDisc() ? discCrossing(obstacle, start, direction)
                           : polygonCrossing(obstacle.corners, start, direction);
}

double penetrationOf(const Obstacle& obstacle, const Rectangle& rectangle,
                     const Pose2& T_map_body) {
  if (obstacle.isDisc()) return discPenetration(obstacle, rectangle, T_map_body);
  // Separating axis theorem: two convex shapes touch if no edge of either separates them.
  const Corners corners = cornersOf(rectangle, T_map_body);
  return std::min(overlapAcrossEdges(obstacle.corners, corners),
                  overlapAcrossEdges(corners, obstacle.corners));
}

ObstacleGrid::ObstacleGrid(const std::vector<Obstacle>& obstacles, double cell_edge)
    : edge_(cell_edge) {
  if (obstacles.empty()) return;
  Extent all = extentOf(obstacles.front());
  std::vector<Extent> extents;
  for (const Obstacle& obstacle : obstacles) {
    extents.push_back(extentOf(obstacle));
    all.low = all.low.cwiseMin(extents.back().low);
    all.high = all.high.cwiseMax(extents.back().high);
  }
  // A rim of one millimetre keeps shapes that end on a cell border inside the grid.
  low_ = all.low.array() - 1e-3;
  edge_ = std::max(edge_, std::sqrt((all.high - all.low).prod() / kMostCells));
  edge_ = std::max(edge_, (all.high - all.low).maxCoeff() / kMostCells);
  columns_ = column(all.high.x() + 1e-3) + 1;
  rows_ = row(all.high.y() + 1e-3) + 1;

  std::vector<std::vector<uint32_t>> cells(cell(0, rows_));
  for (uint32_t i = 0; i < extents.size(); ++i) {
    for (int y = row(extents[i].low.y()); y <= row(extents[i].high.y()); ++y) {
      for (int x = column(extents[i].low.x()); x <= column(extents[i].high.x()); ++x)
        cells[cell(x, y)].push_back(i);
    }
  }
  for (const auto& list : cells) {
    starts_.push_back(static_cast<uint32_t>(indices_.size()));
    indices_.insert(indices_.end(), list.begin(), list.end());
  }
  starts_.push_back(static_cast<uint32_t>(indices_.size()));
}

RayCrossing ObstacleGrid::clip(const Eigen::Vector2d& start, const Eigen::Vector2d& direction,
                               double range) const {
  RayCrossing inside{0.0, range};
  const Eigen::Vector2d high = low_ + edge_ * Eigen::Vector2d(columns_, rows_);
  for (int axis = 0; axis < 2; ++axis) {
    if (direction[axis] == 0.0) {
      if (start[axis] < low_[axis] || start[axis] > high[axis]) return {1.0, 0.0};
      continue;
    }
    const double a = (low_[axis] - start[axis]) / direction[axis];
    const double b = (high[axis] - start[axis]) / direction[axis];
    inside.enter = std::max(inside.enter, std::min(a, b));
    inside.leave = std::min(inside.leave, std::max(a, b));
  }
  return inside;
}

bool insidePolygon(const std::vector<Eigen::Vector2d>& corners, const Eigen::Vector2d& p) {
  bool inside = false;
  for (size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const Eigen::Vector2d& a = corners[i];
    const Eigen::Vector2d& b = corners[j];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x()) inside = !inside;
  }
  return inside;
}

}  // namespace tread::sim
