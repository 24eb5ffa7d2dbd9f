// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/replay/scan_closure.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/LU>

namespace tread {
namespace {

using Eigen::Matrix3d;
using scan_matching::LocalMap;
using scan_matching::PosePrior;
using scan_matching::Registration;
using scan_matching::ScanMatcherConfig;
using scan_matching::ScanPoint;

constexpr double kPriorStd = 0.3;            // [m], and a third of it in rad: a weak prior
constexpr double kLongestSide = 3.0;         // [m] largest distance from the first to the third
constexpr int64_t kLongestTime = 5'000'000;  // [us] longest time from the first to the third

/// Pose of the body at the second of two scans relative to the first.
struct Step {
  Pose2 T_first_second;
  Matrix3d covariance;  ///< of x, y, yaw in the axes of the first
};

std::vector<ScanPoint> pointsOf(const MatchedSweep& matched, const ScanMatcherConfig& config) {
  const auto& sweep = matched.sweep;
  return scanPoints(sweep.returns, sweep.p_body_sensor, matched.pose.v_body,
                    1e-6 * static_cast<double>(sweep.last - sweep.first), config.points);
}

std::optional<Step> stepBetween(const MatchedSweep& first, const MatchedSweep& second,
                                const ScanMatcherConfig& config) {
  LocalMap map(1, 2.0 * config.points.range_max);
  map.add({}, pointsOf(first, config));
  PosePrior prior;
  prior.T_map_body = between(first.pose.T_map_body, second.pose.T_map_body);
  prior.covariance.diagonal() << kPriorStd * kPriorStd, kPriorStd * kPriorStd,
      kPriorStd * kPriorStd / 9.0;
  const std::vector<ScanPoint> points = pointsOf(second, config);
  const Registration laid = registerScan(points, map, prior.T_map_body, prior,
                                         second.sweep.p_body_sensor, config.registration);
  if (laid.undetermined > 0 || laid.matched < config.min_points ||
      laid.overlap < config.min_overlap)
    return std::nullopt;
  const Matrix3d covariance = laid.information.inverse();
  // Rank deficient if limited weights leave no information on a direction.
  for (int axis = 0; axis < 3; ++axis)
    if (!(covariance(axis, axis) > 0.0 && covariance(axis, axis) < prior.covariance(axis, axis)))
      return std::nullopt;
  return Step{laid.T_map_body, covariance};
}

/// Covariance of two consecutive steps, in the axes of the first.
Matrix3d chained(const Step& a, const Step& b) {
  const Pose2 end = a.T_first_second * b.T_first_second;
  Matrix3d swing = Matrix3d::Identity();
  swing(0, 2) = -(end.y - a.T_first_second.y);
  swing(1, 2) = end.x - a.T_first_second.x;
  const double c = std::cos(a.T_first_second.yaw), s = std::sin(a.T_first_second.yaw);
  Matrix3d turned = Matrix3d::Identity();
  turned.topLeftCorner<2, 2>() << c, -s, s, c;
  return swing * a.covariance * swing.transpose() + turned * b.covariance * turned.transpose();
}

bool isTriangle(const MatchedSweep* corners) {
  for (int i = 0; i < 3; ++i) {
    const auto& pose = corners[i].pose;
    if (!pose.position_known || !pose.heading_known || (i > 0 && pose.new_track)) return false;
  }
  return distanceBetween(corners[0].pose.T_map_body, corners[2].pose.T_map_body) <= kLongestSide &&
         corners[2].pose.utime - corners[0].pose.utime <= kLongestTime;
}

}  // namespace

ScanClosure closureOf(const std::vector<MatchedSweep>& sweeps, const ScanMatcherConfig& config) {
  ScanClosure closure;
  double position = 0.0, yaw = 0.0, within = 0.0;
  for (size_t i = 0; i + 2 < sweeps.size(); ++i) {
    if (!isTriangle(&sweeps[i])) continue;
    const auto ab = stepBetween(sweeps[i], sweeps[i + 1], config);
    const auto bc = stepBetween(sweeps[i + 1], sweeps[i + 2], config);
    const auto ac = stepBetween(sweeps[i], sweeps[i + 2], config);
    if (!ab || !bc || !ac) {
      ++closure.undetermined;
      continue;
    }
    const Pose2 round = ab->T_first_second * bc->T_first_second;
    const Eigen::Vector3d gap(round.x - ac->T_first_second.x, round.y - ac->T_first_second.y,
                              wrapAngle(round.yaw - ac->T_first_second.yaw));
    const Matrix3d told = chained(*ab, *bc) + ac->covariance;
    closure.position.push_back(gap.head<2>().norm());
    closure.yaw.push_back(std::abs(gap.z()));
    for (int axis = 0; axis < 3; ++axis) {
      const double square = gap[axis] * gap[axis] / std::max(1e-12, told(axis, axis));
      (axis < 2 ? position : yaw) += square;
      within += square <= 4.0 ? 1.0 : 0.0;
    }
  }
  const double count = std::max(1.0, static_cast<double>(closure.yaw.size()));
  closure.normalized_position = std::sqrt(position / (2.0 * count));
  closure.normalized_yaw = std::sqrt(yaw / count);
  closure.within_two = within / (3.0 * count);
  return closure;
}

}  // namespace tread
