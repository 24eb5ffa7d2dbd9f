// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/surroundings.hpp"

#include <algorithm>
#include <cmath>

namespace tread::planner {
namespace {

constexpr bool kUnknownBlocks = true;

Footprint withMargin(const FootprintSize& size, double margin) {
  return Footprint(size.front, size.rear, size.half_width, margin);
}

}  // namespace

Surroundings::Surroundings(Grid grid, const FootprintSize& size, const Margins& margins)
    : grid_(std::move(grid)), field_(grid_, kUnknownBlocks), margins_(margins) {
  const double check = std::min(margins.check, margins.plan);
  level_margins_ = {0.0, check / 2.0, check, (check + margins.plan) / 2.0};
  for (int i = kPlan; i < kLevels; ++i) {
    const double share = static_cast<double>(i - kPlan) / (kLevels - 1 - kPlan);
    level_margins_.push_back(margins.plan + share * std::max(0.0, margins.largest - margins.plan));
  }
  for (const double margin : level_margins_) levels_.push_back(withMargin(size, margin));
}

int Surroundings::levelWithin(double margin) const {
  int level = kBare;
  while (level + 1 < kLevels && marginOf(level + 1) <= margin) ++level;
  return level;
}

int Surroundings::level(double variance) const {
  return std::max(kPlan, levelWithin(margins_.plan + margins_.growth * std::sqrt(variance)));
}

bool Surroundings::isFree(const Pose2& T_map_body, int level) const {
  return levels_[static_cast<size_t>(level)].isFree(grid_, field_, T_map_body, kUnknownBlocks);
}

int Surroundings::freeLevel(const Pose2& T_map_body, int wanted) const {
  int level = wanted;
  while (level >= 0 && !isFree(T_map_body, level)) --level;
  return level;
}

bool Surroundings::isFarFromAll(const Pose2& T_map_start, const TablePattern& pattern,
                                int level) const {
  // The whole pattern is one look into the field.
  const double around = pattern.radius + levels_[static_cast<size_t>(level)].circumscribed();
  return field_.at(T_map_start * pattern.centre) > around;
}

bool Surroundings::sweepFree(const Pose2& T_map_start, const TablePattern& pattern,
                             int level) const {
  if (isFarFromAll(T_map_start, pattern, level)) return true;
  const Footprint& footprint = levels_[static_cast<size_t>(level)];
  // The end first: patterns that hit something mostly hit it with their end.
  const double c = std::cos(T_map_start.yaw);
  const double s = std::sin(T_map_start.yaw);
  for (auto at = pattern.sweep.rbegin(); at != pattern.sweep.rend(); ++at) {
    const Pose2 pose{T_map_start.x + c * at->pose.x - s * at->pose.y,
                     T_map_start.y + s * at->pose.x + c * at->pose.y,
                     T_map_start.yaw + at->pose.yaw};
    if (!footprint.isFree(grid_, field_, pose, kUnknownBlocks)) return false;
  }
  return true;
}

bool Surroundings::sweepRegains(const Pose2& T_map_start, int start_level,
                                const TablePattern& pattern, int wanted) const {
  if (isFarFromAll(T_map_start, pattern, wanted)) return true;
  const double margin = marginOf(start_level);
  return std::all_of(pattern.sweep.begin(), pattern.sweep.end(), [&](const SweepPose& at) {
    const int level = std::min(wanted, levelWithin(margin + margins_.regain * at.reach));
    const Pose2 pose = T_map_start * at.pose;
    return isFree(pose, level) || (isFree(pose, start_level) && !touchesObstacle(pose, level));
  });
}

bool Surroundings::touchesObstacle(const Pose2& T_map_body, int level) const {
  return levels_[static_cast<size_t>(level)].blockedCells(grid_, T_map_body, false) > 0;
}

Overlap Surroundings::overlap(const Pose2& T_map_body) const {
  const Footprint& bare = levels_[kBare];
  return {bare.blockedCells(grid_, T_map_body, false),
          bare.blockedCells(grid_, T_map_body, kUnknownBlocks)};
}

std::optional<Overlap> Surroundings::escape(const Pose2& T_map_start, const Overlap& at_start,
                                            const TablePattern& pattern) const {
  Overlap here = at_start;
  for (const SweepPose& at : pattern.sweep) {
    here = overlap(T_map_start * at.pose);
    if (!here.within(at_start)) return std::nullopt;
  }
  return here;
}

}  // namespace tread::planner
