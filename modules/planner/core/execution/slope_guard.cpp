// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/slope_guard.hpp"

#include <cmath>

#include "common/geometry/degrees.hpp"

namespace tread::planner {
namespace {

constexpr int64_t kSteep =
    60'000;  // [us] for which it must be too steep: a stone under a track is no slope
constexpr double kRelief =
    0.035;  // [rad] below the limit it is good again; above the reported slope it is worse
constexpr double kTrailStep = 0.1;  // [m]
constexpr size_t kTrail = 40;       // places
constexpr double kGrowth = 0.5;     // [m] of the trail from which the slope's growth is derived
constexpr double kGentle =
    0.5;                       // [1] of the limit: on gentler ground the slope is not extrapolated
constexpr double kBack = 0.8;  // [m] back on the trail, over which the slope grew
constexpr double kBegins = 0.3;     // [m] ahead of the body's origin
constexpr double kEnds = 2.0;       // [m]
constexpr double kHalfWidth = 1.0;  // [m]

}  // namespace

std::string SlopeGuard::words() const {
  const auto degrees = [](double angle) { return std::to_string(std::lround(toDegrees(angle))); };
  return "tilts " + degrees(slope_) + " deg, plans allow " + degrees(max_slope_.value_or(0.0));
}

bool SlopeGuard::steep() const {
  return max_slope_ && slope_ > *max_slope_ - kRelief;
}

double SlopeGuard::expected(const PoseReading& pose) const {
  if (!pose.twist || slope_ < kGentle * *max_slope_) return slope_;
  const double ahead = stop_time_ * std::hypot(pose.twist->v_x, pose.twist->v_y);
  for (auto at = trail_.rbegin(); at != trail_.rend(); ++at) {
    const double way = (pose.T_map_body.position() - at->p_map).norm();
    if (way >= kGrowth) return slope_ + ahead * std::max(0.0, slope_ - at->slope) / way;
  }
  return slope_;
}

std::optional<Fence> SlopeGuard::take(const PoseReading& pose) {
  if (!max_slope_ || pose.utime <= newest_ || !std::isfinite(pose.slope)) return std::nullopt;
  newest_ = pose.utime;
  slope_ = pose.slope;
  const Eigen::Vector2d p_map = pose.T_map_body.position();
  if (trail_.empty() || (p_map - trail_.back().p_map).norm() > kTrailStep)
    trail_.push_back({p_map, slope_});
  if (trail_.size() > kTrail) trail_.pop_front();
  if (slope_ < *max_slope_ - kRelief) told_ = 0.0;
  // While driving back the ground is still steep, which must not stop the robot.
  const double limit = told_ > 0.0 ? told_ + kRelief : *max_slope_;
  if ((told_ > 0.0 ? slope_ : expected(pose)) <= limit) {
    steep_since_.reset();
    return std::nullopt;
  }
  steep_since_ = steep_since_.value_or(pose.utime);
  if (pose.utime - *steep_since_ < kSteep) return std::nullopt;
  steep_since_.reset();
  told_ = slope_;
  return aheadOf(pose.T_map_body, slope_);
}

Fence SlopeGuard::aheadOf(const Pose2& T_map_body, double slope) const {
  const Eigen::Vector2d p_map = T_map_body.position();
  // From the newest position that is far enough back and was less steep.
  Eigen::Vector2d axis(std::cos(T_map_body.yaw), std::sin(T_map_body.yaw));
  for (auto at = trail_.rbegin(); at != trail_.rend(); ++at) {
    if ((p_map - at->p_map).norm() < kBack || at->slope >= slope) continue;
    axis = (p_map - at->p_map).normalized();
    break;
  }
  const Eigen::Vector2d side(-axis.y(), axis.x());
  Fence steep{kName, true, {}};
  for (const auto& [along, across] :
       {std::pair(kBegins, -kHalfWidth), std::pair(kEnds, -kHalfWidth),
        std::pair(kEnds, kHalfWidth), std::pair(kBegins, kHalfWidth)})
    steep.corners.emplace_back(p_map + along * axis + across * side);
  return steep;
}

}  // namespace tread::planner
