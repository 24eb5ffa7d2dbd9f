// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/map/collision_checker.hpp"

#include <cmath>

namespace tread::planner {
namespace {

/// Distances beyond this outside of the footprint are not needed [m].
constexpr double kFarthestLook = 1.5;

/// A pose of a pattern that begins at `start`.
TurnedPose alongFrom(const TurnedPose& start, const SweptPose& at) {
  const double c = start.cos_yaw;
  const double s = start.sin_yaw;
  return {start.x + c * at.pose.x - s * at.pose.y, start.y + s * at.pose.x + c * at.pose.y,
          c * at.cos_yaw - s * at.sin_yaw, s * at.cos_yaw + c * at.sin_yaw};
}

}  // namespace

CollisionChecker::CollisionChecker(Grid grid, const FootprintSize& size, const Margins& margins,
                                   bool unknown_blocks, FencedGround fenced)
    : grid_(std::move(grid)),
      unknown_blocks_(unknown_blocks),
      fenced_(std::move(fenced)),
      margins_(margins),
      arm_(Footprint(size, 0.0).circumscribed()) {
  const double most = arm_ + 2.0 * std::max(margins.plan, margins.largest);
  if (!fenced_.empty()) map_ = grid_;
  fenced_.stamp(grid_);
  field_ = ClearanceField(grid_, unknown_blocks, most + kFarthestLook);
  const double check = std::min(margins.check, margins.plan);
  const double narrow = margins.narrow > 0.0 ? margins.narrow : (check + margins.plan) / 2.0;
  level_margins_ = {0.0, check / 2.0, check, narrow};
  for (int i = kPlan; i < kLevels; ++i) {
    const double share = static_cast<double>(i - kPlan) / (kLevels - 1 - kPlan);
    level_margins_.push_back(margins.plan + share * std::max(0.0, margins.largest - margins.plan));
  }
  for (const double margin : level_margins_) {
    levels_.emplace_back(size, margin);
    // The smallest variance for which plan + growth * sigma reaches the margin.
    const double sigma = std::max(0.0, margin - margins.plan) / std::max(1e-9, margins.growth);
    level_variances_.push_back(static_cast<float>(sigma * sigma));
  }
}

int CollisionChecker::levelWithin(double margin) const {
  int level = kBare;
  while (level + 1 < kLevels && marginOf(level + 1) <= margin) ++level;
  return level;
}

int CollisionChecker::level(const Uncertainty& uncertainty) const {
  // A lower bound without a square root; often sufficient.
  const auto arm = static_cast<float>(arm_);
  const float least = std::max(uncertainty.xx, uncertainty.yy) + arm * arm * uncertainty.yawyaw;
  if (level_variances_.back() <= least) return kLevels - 1;
  const float variance = uncertainty.ofPoint(arm);
  int level = kPlan;
  while (level + 1 < kLevels && level_variances_[static_cast<size_t>(level + 1)] <= variance)
    ++level;
  return level;
}

int CollisionChecker::leastLevel(const Uncertainty& uncertainty) const {
  const double sigma = std::sqrt(uncertainty.ofPoint(static_cast<float>(arm_)));
  int level = kNarrow;
  while (level + 1 < kLevels && marginOf(level) < margins_.growth * sigma) ++level;
  return std::min(level, this->level(uncertainty));
}

bool CollisionChecker::isFree(const TurnedPose& T_map_body, int level) const {
  return levels_[static_cast<size_t>(level)].isFree(field_, T_map_body);
}

int CollisionChecker::freeLevel(const Pose2& T_map_body, int wanted) const {
  int level = wanted;
  while (level >= 0 && !isFree(T_map_body, level)) --level;
  return level;
}

bool CollisionChecker::isFarFromAll(const TurnedPose& at, const TablePattern& pattern,
                                    int level) const {
  // The whole pattern in one lookup.
  const double around = pattern.radius + levels_[static_cast<size_t>(level)].circumscribed();
  const double x = at.x + at.cos_yaw * pattern.centre.x() - at.sin_yaw * pattern.centre.y();
  const double y = at.y + at.sin_yaw * pattern.centre.x() + at.cos_yaw * pattern.centre.y();
  return field_.compare(x, y, static_cast<float>(around + 1e-6)) ==
         ClearanceField::Verdict::kAtLeast;
}

bool CollisionChecker::sweepFree(const TurnedPose& start, const TablePattern& pattern,
                                 int level) const {
  if (isFarFromAll(start, pattern, level)) return true;
  return sweptFootprintFree(start, pattern.swept_footprint, levels_[static_cast<size_t>(level)]);
}

bool CollisionChecker::sweptFootprintFree(const TurnedPose& start, const SweptFootprint& cover,
                                          const Footprint& footprint) const {
  // The end first: patterns that hit something mostly do so at their end.
  for (auto pose = cover.poses.rbegin(); pose != cover.poses.rend(); ++pose)
    if (!footprint.isFree(field_, alongFrom(start, pose->at))) return false;
  const auto inset = static_cast<float>(cover.front - footprint.size().front);
  int free_way = -1;  // the last one checked completely
  for (const CornerDisc& disc : cover.discs) {
    const auto x = static_cast<double>(disc.x - inset * disc.out_x);
    const auto y = static_cast<double>(disc.y - inset * disc.out_y);
    const float radius = disc.radius + std::abs(inset) * disc.spread;
    if (field_.discFree(start.x + start.cos_yaw * x - start.sin_yaw * y,
                        start.y + start.sin_yaw * x + start.cos_yaw * y, radius) ||
        disc.way == free_way)
      continue;
    if (!betweenFree(start, cover, cover.poses[static_cast<size_t>(disc.way)], footprint))
      return false;
    free_way = disc.way;
  }
  return true;
}

bool CollisionChecker::betweenFree(const TurnedPose& start, const SweptFootprint& cover,
                                   const CheckedPose& way, const Footprint& footprint) const {
  for (size_t i = way.first_between; i < way.first_between + way.between_count; ++i)
    if (!footprint.isFree(field_, alongFrom(start, cover.between[i]))) return false;
  return true;
}

bool CollisionChecker::sweepRegains(const TurnedPose& start, int start_level,
                                    const TablePattern& pattern, int wanted) const {
  if (isFarFromAll(start, pattern, wanted)) return true;
  const double margin = marginOf(start_level);
  if (!sweptFootprintFree(start, pattern.swept_footprint,
                          levels_[static_cast<size_t>(start_level)]))
    return false;
  return std::all_of(
      pattern.swept_poses.begin(), pattern.swept_poses.end(), [&](const SweptPose& at) {
        const int level = std::min(wanted, levelWithin(margin + margins_.regain * at.reach));
        const TurnedPose pose = alongFrom(start, at);
        return isFree(pose, level) || (isFree(pose, start_level) && !touchesObstacle(pose, level));
      });
}

bool CollisionChecker::touchesObstacle(const TurnedPose& pose, int level) const {
  const Pose2 plain{pose.x, pose.y, std::atan2(pose.sin_yaw, pose.cos_yaw)};
  return levels_[static_cast<size_t>(level)].blockedCells(grid_, plain, false) > 0;
}

Overlap CollisionChecker::overlap(const Pose2& T_map_body) const {
  const Footprint& bare = levels_[kBare];
  const Grid& map = map_ ? *map_ : grid_;
  const int blocked = bare.blockedCells(map, T_map_body, unknown_blocks_);
  return {bare.blockedCells(map, T_map_body, false), blocked,
          map_ ? bare.blockedCells(grid_, T_map_body, unknown_blocks_) : blocked,
          static_cast<float>(fenced_.depth(T_map_body, bare.size()))};
}

std::optional<Overlap> CollisionChecker::escape(const Pose2& T_map_start, const Overlap& at_start,
                                                const TablePattern& pattern) const {
  Overlap here = at_start;
  for (const SweptPose& at : pattern.swept_poses) {
    here = overlap(T_map_start * at.pose);
    if (!here.within(at_start)) return std::nullopt;
  }
  return here;
}

}  // namespace tread::planner
