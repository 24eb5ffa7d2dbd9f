// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/scan_matching/core/scan_points.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/principal_axes.hpp"

namespace tread::scan_matching {
namespace {

constexpr double kReach = 0.3;          // [m] of a line fit, to either side
constexpr double kFarthestReach = 1.5;  // [m] where points are sparse
constexpr size_t kMostNeighbours = 12;  // to either side
constexpr size_t kFewest = 5;           // points of a line fit
constexpr double kStraight = 0.04;  // [1] share of the variance along the line allowed across it

std::vector<Eigen::Vector2d> deskewed(const std::vector<PlanarReturn>& returns, const Twist2& twist,
                                      double duration) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(returns.size());
  for (const PlanarReturn& hit : returns)
    points.push_back(integrate(twist, (hit.share - 0.5) * duration) * hit.p_body);
  return points;
}

/// Means of neighbours within `spacing` of the first of them.
std::vector<Eigen::Vector2d> thinned(const std::vector<Eigen::Vector2d>& points, double spacing) {
  std::vector<Eigen::Vector2d> means;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  double count = 0.0;
  for (const Eigen::Vector2d& point : points) {
    if (count > 0.0 && (point - first).squaredNorm() > spacing * spacing) {
      means.push_back(sum / count);
      sum.setZero();
      count = 0.0;
    }
    if (count == 0.0) first = point;
    sum += point;
    count += 1.0;
  }
  if (count > 0.0) means.push_back(sum / count);
  return means;
}

/// Distance from a point to the nearer of its two neighbours [m].
double spreadAt(const std::vector<Eigen::Vector2d>& points, size_t i) {
  double nearest = kFarthestReach;
  if (i > 0) nearest = std::min(nearest, (points[i] - points[i - 1]).norm());
  if (i + 1 < points.size()) nearest = std::min(nearest, (points[i + 1] - points[i]).norm());
  return nearest;
}

/// The range [begin, end) of neighbours in the order of the beams.
std::pair<size_t, size_t> neighbours(const std::vector<Eigen::Vector2d>& points, size_t i) {
  // Grazing beams hit the same wall at large distances.
  const double reach = std::clamp(3.0 * spreadAt(points, i), kReach, kFarthestReach);
  const auto near = [&](size_t j) { return (points[j] - points[i]).norm() <= reach; };
  size_t begin = i;
  size_t end = i + 1;
  while (begin > 0 && i - begin < kMostNeighbours && near(begin - 1)) --begin;
  while (end < points.size() && end - i <= kMostNeighbours && near(end)) ++end;
  return {begin, end};
}

/// False if the point's shape is unknown.
bool describe(const std::vector<Eigen::Vector2d>& points, size_t i,
              const Eigen::Vector2d& p_body_sensor, double range_noise, ScanPoint& point) {
  const auto [begin, end] = neighbours(points, i);
  const auto count = static_cast<double>(end - begin);
  point.p = points[i];
  point.spread = spreadAt(points, i);
  if (end - begin < kFewest) {
    // A post or a trunk far away. Single points may belong to a wall at a grazing angle.
    point.shape = Shape::kScatter;
    const auto beside = [&](size_t j) { return (points[j] - points[i]).norm() <= kReach; };
    return (i > begin && beside(i - 1)) || (i + 1 < end && beside(i + 1));
  }
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (size_t j = begin; j < end; ++j) mean += points[j] / count;
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (size_t j = begin; j < end; ++j)
    scatter += (points[j] - mean) * (points[j] - mean).transpose();
  const PrincipalAxes axes = principalAxes(scatter);
  const double across = std::max(0.0, axes.variances[0]);
  const double along = axes.variances[1];
  point.normal = axes.directions.col(0);
  if (point.normal.dot(p_body_sensor - point.p) < 0.0) point.normal = -point.normal;
  const double variance = std::max(across / (count - 2.0), range_noise * range_noise);
  point.normal_variance = variance / std::max(along, 1e-9);
  point.shape = across <= kStraight * along ? Shape::kLine : Shape::kScatter;
  return true;
}

}  // namespace

std::vector<ScanPoint> scanPoints(const std::vector<PlanarReturn>& returns,
                                  const Eigen::Vector2d& p_body_sensor, const Twist2& twist,
                                  double duration, const ScanPointsConfig& config) {
  std::vector<Eigen::Vector2d> points = deskewed(returns, twist, duration);
  const double reach = config.range_max * config.range_max;
  const auto far = [&](const Eigen::Vector2d& p) {
    return (p - p_body_sensor).squaredNorm() > reach;
  };
  points.erase(std::remove_if(points.begin(), points.end(), far), points.end());
  points = thinned(points, config.spacing);
  std::vector<ScanPoint> described;
  described.reserve(points.size());
  ScanPoint point;
  for (size_t i = 0; i < points.size(); ++i)
    if (describe(points, i, p_body_sensor, config.range_noise, point)) described.push_back(point);
  return described;
}

}  // namespace tread::scan_matching
