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

/// How much room is kept around the footprint [m].
struct Margins {
  double check = 0.03;  ///< when what is already under way is checked again
  double plan = 0.05;   ///< when the next pattern is chosen
  /// Where no plan with more leads on, and for a plan that is kept, if growth times the standard
  /// deviation is no more; 0 = that is not tried. Not less than check, not more than plan.
  double narrow = 0.0;
  double growth = 0.5;    ///< [1] of the standard deviation of where the pattern ends
  double largest = 0.09;  ///< never more than this, so that narrow gaps stay open
  double regain =
      0.08;  ///< [1] where the vehicle begins with less, it must keep so much more per metre

  /// With which a pattern may be planned.
  double least() const { return narrow > 0.0 ? narrow : plan; }
};

/// Blocked cells under the footprint, without margin.
struct Overlap {
  int obstacles = 0;  ///< of the map
  int blocked = 0;    ///< obstacles and unknown, of the map
  int all = 0;        ///< those, and what fences forbid: no obstacle may take the place of a fence
  /// [m] by which it is too near to a fence, or over it: where all is blocked only this tells the
  /// way back from the way out.
  float fenced = 0.0F;

  bool none() const { return all == 0; }
  bool within(const Overlap& other) const {
    constexpr float kRounding = 1e-4F;
    return obstacles <= other.obstacles && blocked <= other.blocked && all <= other.all &&
           fenced <= other.fenced + kRounding;
  }
};

/// What is around the vehicle at one moment: asked whether poses and patterns are free. Unknown is
/// not free unless it is said to be.
class CollisionChecker {
 public:
  /// `unknown_blocks`: false lets the vehicle drive where nothing is known.
  CollisionChecker(Grid grid, const FootprintSize& size, const Margins& margins,
                   bool unknown_blocks = true, FencedGround fenced = {});

  const Grid& grid() const { return grid_; }
  const ClearanceField& field() const { return field_; }
  const Margins& margins() const { return margins_; }

  /// Distance from a point to the nearest cell that is not free [m], a lower bound.
  double clearance(const Eigen::Vector2d& p_map) const { return field_.at(p_map); }
  /// 1 in a cell that is not free, falling to 0 where nothing is nearer than `distance` [m].
  double nearness(double x, double y, double distance) const {
    return std::max(0.0, 1.0 - field_.quick(x, y) / distance);
  }
  /// Levels of margin, rising: none, that for checking, that for narrow places, that for planning,
  /// and more between them.
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
  /// Level for a pose of this uncertainty; kPlan or above.
  /** What counts is the footprint's corner, which a turn moves, too. */
  int level(const Uncertainty& uncertainty) const;
  /// The least level for a pose of this uncertainty where there is no plan with more room: kNarrow,
  /// or what growth times the standard deviation asks for, but never more than level().
  int leastLevel(const Uncertainty& uncertainty) const;
  /// Whether the footprint with the margin of a level is free at a pose.
  bool isFree(const Pose2& T_map_body, int level) const {
    return isFree(turned(T_map_body), level);
  }
  bool isFree(const TurnedPose& T_map_body, int level) const;
  /// Highest level, at most `wanted`, at which a pose is free; -1 if it is not free at all.
  int freeLevel(const Pose2& T_map_body, int wanted) const;
  /// Whether every pose of a pattern is free, begun at a free pose.
  /** Between poses that are checked a corner may be hit by no more than 5 mm. */
  bool sweepFree(const TurnedPose& T_map_start, const TablePattern& pattern, int level) const;
  bool sweepFree(const Pose2& T_map_start, const TablePattern& pattern, int level) const {
    return sweepFree(turned(T_map_start), pattern, level);
  }
  /// The same for a start that is free only at a lower level than `wanted`: the farther from there,
  /// the more margin to obstacles must be kept, up to the wanted one. To the unknown the start's
  /// own margin is enough: what was never seen beside the vehicle is no reason to stay.
  bool sweepRegains(const TurnedPose& T_map_start, int start_level, const TablePattern& pattern,
                    int wanted) const;
  /// Blocked cells under the footprint: for leaving a place that is not free.
  Overlap overlap(const Pose2& T_map_body) const;
  /// Overlap at the end if no pose of the pattern overlaps more than its start does; else nothing.
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
  std::optional<Grid> map_;  // without them, where there are any
  bool unknown_blocks_;
  FencedGround fenced_;
  ClearanceField field_;
  Margins margins_;
  double arm_;  // [m] from the body's origin to its farthest corner
  std::vector<Footprint> levels_;
  std::vector<double> level_margins_;
  std::vector<float> level_variances_;  // [m2] from which on a level is wanted
};

}  // namespace tread::planner
