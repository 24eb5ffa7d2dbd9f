// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/grid/grid.hpp"

namespace tread::planner {

/// A rectangle of coarse cells; cell (x, y) has its lower corner at (x, y) * coarseSize().
struct ClearanceWindow {
  int lower_x = 0;
  int lower_y = 0;
  int width = 0;
  int height = 0;
  std::vector<float> clearance;  ///< [m] greatest distance to an obstacle in the cell
  std::vector<uint8_t> unknown;  ///< 1 where at least half of the cell is unknown
  std::vector<Cell> roughness;   ///< greatest cost of the free cells in it; empty = nobody asks

  size_t at(int x, int y) const {
    return static_cast<size_t>(y - lower_y) * static_cast<size_t>(width) +
           static_cast<size_t>(x - lower_x);
  }
};

/// A map of the clearance in coarse cells.
class ClearanceSource {
 public:
  virtual ~ClearanceSource() = default;
  /// [m] side of a coarse cell.
  virtual double coarseSize() const = 0;
  /// The extent of the map, without cells; nothing if it is endless.
  virtual std::optional<ClearanceWindow> bounds() const { return std::nullopt; }
  /// Fills in what is known in the window's rectangle and leaves the rest as it is.
  virtual void fill(ClearanceWindow& window) const = 0;
};

/// Where to go: pose in map and how near is near enough.
struct Goal {
  int64_t id = 0;
  Pose2 T_map_goal;
  double position_tolerance = 0.5;  ///< [m] > 0
  double yaw_tolerance = 4.0;       ///< [rad] > 0; pi or more = any heading
};

/// Whether a pose lies within a share [1] of a goal's tolerances.
inline bool isWithin(const Goal& goal, const Pose2& T_map_body, double share = 1.0) {
  const double dx = T_map_body.x - goal.T_map_goal.x;
  const double dy = T_map_body.y - goal.T_map_goal.y;
  const double near = share * goal.position_tolerance;
  if (dx * dx + dy * dy > near * near) return false;
  return goal.yaw_tolerance >= kPi ||
         std::abs(wrapAngle(T_map_body.yaw - goal.T_map_goal.yaw)) <= share * goal.yaw_tolerance;
}

/// Weights and extent of DistanceToGoal.
struct DistanceFieldConfig {
  double inflation =
      0.0;            ///< [m] clearance below which a cell is blocked: half the width, at least
  double wide = 0.7;  ///< [m] clearance from which on ground counts as open
  double tight_weight = 1.0;    ///< [1] extra length of a just passable cell; 0 = none
  double detour_weight = 8.0;   ///< [1] extra length where the vehicle did not get through
  double area_margin = 12.0;    ///< [m] around vehicle and goal; grows where that is not enough
  double max_area = 120.0;      ///< [m] longest side of the area, unless the goal is farther off
  double max_distance = 150.0;  ///< [m] goals farther off are refused
  double reach = 14.0;          ///< [m] around the vehicle that must be filled in
  /// What a metre on a cell of a cost counts, [m] each; empty = all ground counts the same.
  std::vector<float> slowness;
};

/// A spot to go round, because the vehicle did not get through.
struct Detour {
  Eigen::Vector2d p_map{0.0, 0.0};
  double radius = 0.6;  ///< [m]
};

/// Polled during a computation: true ends it early.
using Interruption = std::function<bool()>;

/// The cells of a rectangle of map, numbered row by row, with a rim of further ones around them.
struct RimmedCells {
  double size = 0.2;      ///< [m] side of a cell
  double per_size = 5.0;  ///< [1/m]
  int lower_x = 0;
  int lower_y = 0;
  int width = 0;  ///< without the rim
  int height = 0;
  int stride = 0;  ///< width with the rim

  bool empty() const { return width == 0 || height == 0; }
  size_t count() const { return static_cast<size_t>(stride) * static_cast<size_t>(height + 2); }
  /// Number of the cell in a column and row, counted from the rectangle's lower left one.
  size_t number(int x, int y) const { return static_cast<size_t>((y + 1) * stride + x + 1); }
  /// A cell, and how far from its centre a point lies [cells]; cell 0, of the rim, for all outside.
  struct Place {
    size_t cell = 0;
    float dx = 0.0F;
    float dy = 0.0F;
  };
  Place placeOf(double x, double y) const {
    const double column = x * per_size - lower_x;
    const double row = y * per_size - lower_y;
    if (!(column >= 0.0 && row >= 0.0 && column < width && row < height)) return {};
    const int cx = static_cast<int>(column);
    const int cy = static_cast<int>(row);
    return {number(cx, cy), static_cast<float>(column - cx - 0.5),
            static_cast<float>(row - cy - 0.5)};
  }
  /// The cell under a point; the nearest one for a point outside.
  size_t cellAt(const Eigen::Vector2d& p_map) const;
  Eigen::Vector2d centreOf(size_t cell) const;
};

/// Length of the shortest way to the goal around known obstacles, from everywhere [m].
/** Fast marching (first order, upwind) from the goal over coarse cells: obstacles are grown by half
 * the vehicle's width, unknown is passable. With all weights 0, kAdmissibleShare of the length over
 * the best speed of a pattern set is an admissible heuristic of the time to go. Settled bucket by
 * bucket, no farther than needed around the vehicle. */
class DistanceToGoal {
 public:
  /// Lengths times this do not exceed the true ones (first-order error, coarse cells; tested).
  static constexpr double kAdmissibleShare = 0.92;
  static constexpr double kMuchNearer = 0.5;  ///< [m] see nearestWithinReach()

  DistanceToGoal() = default;
  DistanceToGoal(const ClearanceSource& map, const Goal& goal, const Eigen::Vector2d& p_vehicle,
                 const std::vector<Detour>& detours, const DistanceFieldConfig& config) {
    compute(map, goal, p_vehicle, detours, config);
  }
  /// Recomputes in place. If interrupted, cells not yet settled count as far as the farthest
  /// settled.
  void compute(const ClearanceSource& map, const Goal& goal, const Eigen::Vector2d& p_vehicle,
               const std::vector<Detour>& detours, const DistanceFieldConfig& config,
               const Interruption& interruption = {});

  /// Length from a point to the rim of the goal's tolerance [m]; infinite if there is no way.
  /** Interpolated between coarse cells. On ground that is blocked: from the best cell within half a
   * metre. */
  double length(const Eigen::Vector2d& p_map) const;

  /// Length at a point, and the direction of the way.
  struct Sample {
    float length = 0.0F;   ///< [m] infinite if there is no way
    float along_x = 0.0F;  ///< unit vector towards the goal; zero where none is known
    float along_y = 0.0F;
  };
  /// Quicker than length(): from one cell, whose slope is followed. Off by at most cellSlack() from
  /// what the cells around would tell.
  Sample sample(double x, double y) const {
    const RimmedCells::Place at = cells_.placeOf(x, y);
    if (!(settled_[at.cell] < kOpen)) return {static_cast<float>(length({x, y})), 0.0F, 0.0F};
    const Slope& slope = slopes_[at.cell];
    const float gone = slope.step * (slope.along_x * at.dx + slope.along_y * at.dy);
    return {std::max(0.0F, settled_[at.cell] - gone), slope.along_x, slope.along_y};
  }
  /// Whether sample() needs no length(), which takes long and is wanted on blocked ground mostly.
  bool isSettled(double x, double y) const { return settled_[cells_.placeOf(x, y).cell] < kOpen; }
  /// What the length at a point may be off by, because cells are coarse [m].
  double cellSlack() const { return 0.75 * cells_.size; }
  /// Length from a point until the way to the goal leaves what is known [m]; capped at 10 m.
  double untilUnknown(const Eigen::Vector2d& p_map) const;
  /// Unit vector along the way to the goal at a point; zero at the goal or where there is no way.
  Eigen::Vector2d direction(const Eigen::Vector2d& p_map) const;
  /// Points down the way to the goal, a step apart, at most `count`.
  std::vector<Eigen::Vector2d> descend(const Eigen::Vector2d& p_map, double step, int count) const;
  /// Why there is no way from the vehicle to the goal in all that is known, unknown being passable;
  /// empty if there is one.
  const std::string& problem() const { return problem_; }
  bool unreachable() const { return !problem_.empty(); }
  /// Whether obstacles are why.
  bool enclosed() const { return enclosed_; }
  /// Where there is no way to the goal: the point nearest to it among those that the vehicle can
  /// get to. Nothing if the vehicle stands on blocked ground, or nothing was computed.
  /** `before`, what was chosen the last time, is kept where nothing else is nearer by kMuchNearer:
   * between two points that are as good the vehicle must not go back and forth. */
  std::optional<Eigen::Vector2d> nearestWithinReach(
      const Eigen::Vector2d& p_vehicle, const Eigen::Vector2d& p_goal,
      const std::optional<Eigen::Vector2d>& before = std::nullopt) const;
  /// Whether a point lies in the area that was computed, `reach` [m] from its border at least.
  bool covers(const Eigen::Vector2d& p_map, double reach) const;
  /// Number of coarse cells filled in, for measuring.
  int filled() const { return filled_; }

 private:
  class March;
  static constexpr float kUnknownCap = 10.0F;  // [m]
  static constexpr float kOpen = std::numeric_limits<float>::infinity();
  static constexpr float kNoWay = kOpen;
  /// How the length changes around a cell.
  struct Slope {
    float along_x = 0.0F;  // unit vector towards the goal
    float along_y = 0.0F;
    float step = 0.0F;  // [m] of length across a cell
    float until_unknown = 0.0F;
  };

  void layOut(const RimmedCells& cells);
  void paint(const ClearanceSource& map, const std::vector<Detour>& detours,
             const DistanceFieldConfig& config);
  double lengthNearby(const Eigen::Vector2d& p_map) const;

  RimmedCells cells_;                  // blocked in the rim
  std::vector<float> slowness_;        // [m of way per m]; infinite where blocked or settled
  std::vector<float> tentative_;       // [m] as short as was found
  std::vector<float> settled_{kOpen};  // [m] final; infinite before
  std::vector<Slope> slopes_;          // of settled cells; of others anything
  std::vector<uint8_t> unknown_;
  float cut_ = 0.0F;  // beyond this nothing was filled in
  bool cut_short_ = false;
  std::string problem_;
  bool enclosed_ = false;
  int filled_ = 0;
};

}  // namespace tread::planner
