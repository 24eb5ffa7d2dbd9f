// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "common/grid/footprint.hpp"
#include "common/grid/grid.hpp"
#include "modules/planner/core/map/fenced_ground.hpp"
#include "modules/planner/core/search/pattern_table.hpp"

namespace tread::planner {

/// Margins kept around the footprint [m].
struct Margins {
  double check = 0.03;  ///< for checking patterns that are already running
  double plan = 0.05;   ///< for choosing the next pattern
  /// If no plan with more margin leads on, and for a plan that is kept, provided that growth times
  /// the standard deviation is no larger; 0 = not used. At least check, at most plan.
  double narrow = 0.0;
  double growth = 0.5;    ///< [1] of the standard deviation of where the pattern ends
  double largest = 0.09;  ///< upper limit, so that narrow gaps stay open
  double regain = 0.08;   ///< [1] after a start with a smaller margin, the required margin grows by
                          ///< this per metre

  /// The smallest margin for planning a pattern.
  double least() const { return narrow > 0.0 ? narrow : plan; }
};

/// Blocked cells under the footprint, without margin.
struct Overlap {
  int obstacles = 0;  ///< of the map
  int blocked = 0;    ///< obstacles and unknown, of the map
  int all = 0;        ///< those, and cells forbidden by fences: obstacles and fences are counted
                      ///< separately, so that one cannot replace the other
  /// [m] by which it is too close to a fence, or beyond it: if everything is blocked, only this
  /// distinguishes back from farther out.
  float fenced = 0.0F;

  bool none() const { return all == 0; }
  bool within(const Overlap& other) const {
    constexpr float kRounding = 1e-4F;
    return obstacles <= other.obstacles && blocked <= other.blocked && all <= other.all &&
           fenced <= other.fenced + kRounding;
  }
};

/// The surroundings of the vehicle at one instant: whether poses and patterns are free. Unknown is
/// not free unless configured to be.
class CollisionChecker {
 public:
  /// `unknown_blocks`: false lets the vehicle drive on unknown ground.
  CollisionChecker(Grid grid, const FootprintSize& size, const Margins& margins,
                   bool unknown_blocks = true, FencedGround fenced = {});

  const Grid& grid() const { return grid_; }
  const ClearanceField& field() const { return field_; }
  const Margins& margins() const { return margins_; }

  /// Distance from a point to the nearest cell that is not free [m], a lower bound.
  double clearance(const Eigen::Vector2d& p_map) const { return field_.at(p_map); }
  /// 1 in a cell that is not free, falling to 0 at a clearance of `distance` [m].
  double nearness(double x, double y, double distance) const {
    return std::max(0.0, 1.0 - field_.quick(x, y) / distance);
  }
  /// Levels of margin in increasing order: none, for checking, for narrow places, for planning, and
  /// more between them.
  static constexpr int kBare = 0;
  static constexpr int kCheck = 2;
  static constexpr int kNarrow = 3;
  static constexpr int kPlan = 4;
  static constexpr int kLevels = 8;
  /// [m] of the smallest disc around the body's origin that contains the bare footprint.
  double circumscribedRadius() const { return levels_.front().circumscribed(); }
  /// Without margin.
  const FootprintSize& footprint() const { return levels_.front().size(); }
  double marginOf(int level) const { return level_margins_[static_cast<size_t>(level)]; }
  /// Level for a pose with this uncertainty; kPlan or above.
  /** The footprint's corner is decisive, because a turn moves it, too. */
  int level(const Uncertainty& uncertainty) const;
  /// The least level for a pose with this uncertainty if there is no plan with a larger margin:
  /// kNarrow, or growth times the standard deviation, but never more than level().
  int leastLevel(const Uncertainty& uncertainty) const;
  /// Whether the footprint with the margin of a level is free at a pose.
  bool isFree(const Pose2& T_map_body, int level) const {
    return isFree(turned(T_map_body), level);
  }
  bool isFree(const TurnedPose& T_map_body, int level) const;
  /// Highest level, at most `wanted`, at which a pose is free; -1 if it is not free at all.
  int freeLevel(const Pose2& T_map_body, int wanted) const;
  /// Whether every pose of a pattern is free, started at a free pose.
  /** Between checked poses a corner may penetrate by at most 5 mm. */
  bool sweepFree(const TurnedPose& T_map_start, const TablePattern& pattern, int level) const;
  bool sweepFree(const Pose2& T_map_start, const TablePattern& pattern, int level) const {
    return sweepFree(turned(T_map_start), pattern, level);
  }
  /// The same for a start that is free only at a lower level than `wanted`: the required margin to
  /// obstacles grows with the distance from there, up to the wanted one. For unknown ground the
  /// start's own margin suffices: unseen ground beside the vehicle is no reason to stay.
  bool sweepRegains(const TurnedPose& T_map_start, int start_level, const TablePattern& pattern,
                    int wanted) const;
  /// Blocked cells under the footprint, for leaving a place that is not free.
  Overlap overlap(const Pose2& T_map_body) const;
  /// Overlap at the end if no pose of the pattern overlaps more than its start does; else nullopt.
  std::optional<Overlap> escape(const Pose2& T_map_start, const Overlap& at_start,
                                const TablePattern& pattern) const;

 private:
  int levelWithin(double margin) const;
  bool touchesObstacle(const TurnedPose& T_map_body, int level) const;
  bool isFarFromAll(const TurnedPose& T_map_start, const TablePattern& pattern, int level) const;
  bool sweptFootprintFree(const TurnedPose& T_map_start, const SweptFootprint& cover,
                          const Footprint& footprint) const;
  bool betweenFree(const TurnedPose& T_map_start, const SweptFootprint& cover,
                   const CheckedPose& way, const Footprint& footprint) const;

  Grid grid_;                // with fences
  std::optional<Grid> map_;  // without fences, if there are any
  bool unknown_blocks_;
  FencedGround fenced_;
  ClearanceField field_;
  Margins margins_;
  double arm_;  // [m] from the body's origin to its farthest corner
  std::vector<Footprint> levels_;
  std::vector<double> level_margins_;
  std::vector<float> level_variances_;  // [m2] from which a level is required
};

}  // namespace tread::planner
