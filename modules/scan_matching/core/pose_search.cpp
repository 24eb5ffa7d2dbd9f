// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/scan_matching/core/pose_search.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace tread::scan_matching {
namespace {

constexpr double kDeviations = 2.5;  // half of the window
constexpr double kMostShift = 1.5;   // [m] the same
constexpr double kMostTurn = 0.6;    // [rad]
constexpr size_t kMostPoints = 120;  // looked at
constexpr double kCoarse = 0.2;      // [m] between tried places
constexpr double kPriorCost = 4.0;   // [of 255] cost of one prior variance of deviation

/// Tests poses of a lattice and keeps the best.
class Search {
 public:
  Search(const std::vector<ScanPoint>& points, const LocalMap& map, const PosePrior& prior)
      : grid_(map.points()), prior_(prior), information_(prior.covariance.inverse()) {
    const size_t stride = points.size() / kMostPoints + 1;
    double squares = 0.0;
    for (size_t i = 0; i < points.size(); i += stride) {
      points_.push_back(points[i].p);
      squares += points[i].p.squaredNorm();
    }
    lever_ = std::sqrt(squares / std::max(1.0, static_cast<double>(points_.size())));
  }

  /// Every pose within `shift` [m] and `turn` [rad] of `middle`, `step` [m] apart.
  void tryAll(const Pose2& middle, double shift, double turn, double step) {
    const double yaw_step = std::clamp(step / std::max(lever_, 1.0), 0.005, 0.1);
    const int turns = static_cast<int>(std::ceil(turn / yaw_step));
    const int shifts = static_cast<int>(std::ceil(shift / step));
    for (int k = -turns; k <= turns; ++k) {
      const double yaw = middle.yaw + k * yaw_step;
      turnTo(yaw);
      for (int j = -shifts; j <= shifts; ++j)
        for (int i = -shifts; i <= shifts; ++i)
          tryPose({middle.x + i * step, middle.y + j * step, yaw});
    }
  }
  const Pose2& best() const { return best_; }

 private:
  void turnTo(double yaw) {
    turned_.clear();
    for (const Eigen::Vector2d& p : points_) turned_.push_back(Pose2{0.0, 0.0, yaw} * p);
  }
  void tryPose(const Pose2& pose) {
    int sum = 0;
    for (const Eigen::Vector2d& p : turned_) sum += grid_.at(p + pose.position());
    const Eigen::Vector3d off(pose.x - prior_.T_map_body.x, pose.y - prior_.T_map_body.y,
                              wrapAngle(pose.yaw - prior_.T_map_body.yaw));
    const double mean = sum / std::max(1.0, static_cast<double>(points_.size()));
    const double score = mean - kPriorCost * off.dot(information_ * off);
    if (score <= score_) return;
    score_ = score;
    best_ = pose;
  }

  LikelihoodGrid grid_;
  PosePrior prior_;
  Eigen::Matrix3d information_;
  std::vector<Eigen::Vector2d> points_;  ///< p_body
  std::vector<Eigen::Vector2d> turned_;  ///< the same, map axes
  double lever_ = 1.0;                   ///< [m]
  double score_ = -1e9;
  Pose2 best_;
};

}  // namespace

Pose2 searchPose(const std::vector<ScanPoint>& points, const LocalMap& map,
                 const PosePrior& prior) {
  const double std = std::sqrt(std::max(prior.covariance(0, 0), prior.covariance(1, 1)));
  const double shift = std::min(kDeviations * std, kMostShift);
  const double turn = std::min(kDeviations * std::sqrt(prior.covariance(2, 2)), kMostTurn);
  Search search(points, map, prior);
  search.tryAll(prior.T_map_body, shift, turn, kCoarse);
  const Pose2 coarse = search.best();
  const double yaw_step = kCoarse / 2.0 / 5.0;
  search.tryAll(coarse, kCoarse / 2.0, yaw_step, kCoarse / 2.0);
  return search.best();
}

}  // namespace tread::scan_matching
