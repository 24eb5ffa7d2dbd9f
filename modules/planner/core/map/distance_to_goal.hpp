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
  std::vector<float> clearance;  ///< [m] largest distance to an obstacle in the cell
  std::vector<uint8_t> unknown;  ///< 1 where at least half of the cell is unknown
  std::vector<Cell> roughness;   ///< largest cost of the free cells in it; empty = not needed

  size_t at(int x, int y) const {
    return static_cast<size_t>(y - lower_y) * static_cast<size_t>(width) +
           static_cast<size_t>(x - lower_x);
  }
};

/// A source of clearance in coarse cells.
class ClearanceSource {
 public:
  virtual ~ClearanceSource() = default;
  /// [m] side of a coarse cell.
  virtual double coarseSize() const = 0;
  /// The extent of the map, without cells; nullopt if it is unbounded.
  virtual std::optional<ClearanceWindow> bounds() const { return std::nullopt; }
  /// Fills in the known cells of the window's rectangle and leaves the others unchanged.
  virtual void fill(ClearanceWindow& window) const = 0;
};

/// The goal: pose in map and tolerances.
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
  double inflation = 0.0;  ///< [m] clearance below which a cell is blocked: at least half the width
  double wide = 0.7;       ///< [m] clearance from which ground counts as open
  double tight_weight = 1.0;    ///< [1] extra length of a barely passable cell; 0 = none
  double detour_weight = 8.0;   ///< [1] extra length where the vehicle did not get through
  double area_margin = 12.0;    ///< [m] around vehicle and goal; grows if it is too small
  double max_area = 120.0;      ///< [m] longest side of the area, unless the goal is farther away
  double max_distance = 150.0;  ///< [m] more distant goals are refused
  double reach = 14.0;          ///< [m] around the vehicle that must be computed
  /// Weight of a metre on a cell of each cost, [m] each; empty = all ground is equal.
  std::vector<float> slowness;
};

/// A spot to avoid, because the vehicle did not get through.
struct Detour {
  Eigen::Vector2d p_map{0.0, 0.0};
  double radius = 0.6;  ///< [m]
};

/// Polled during a computation: true ends it early.
using Interruption = std::function<bool()>;

/// The cells of a rectangle of map, numbered row by row, with a border of further cells.
struct RimmedCells {
  double size = 0.2;      ///< [m] side of a cell
  double per_size = 5.0;  ///< [1/m]
  int lower_x = 0;
  int lower_y = 0;
  int width = 0;  ///< without the rim
  int height = 0;
  int stride = 0;  ///< width including the border

  bool empty() const { return width == 0 || height == 0; }
  size_t count() const { return static_cast<size_t>(stride) * static_cast<size_t>(height + 2); }
  /// Number of the cell in a column and row, counted from the rectangle's lower left cell.
  size_t number(int x, int y) const { return static_cast<size_t>((y + 1) * stride + x + 1); }
  /// A cell, and the offset of a point from its centre [cells]; cell 0, in the border, for all
  /// points outside.
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
  /// The cell that contains a point; the nearest one for a point outside.
  size_t cellAt(const Eigen::Vector2d& p_map) const;
  Eigen::Vector2d centreOf(size_t cell) const;
};

/// Length of the shortest path to the goal around known obstacles, from everywhere [m].
/** Fast marching (first order, upwind) from the goal over coarse cells: obstacles are inflated by
 * half the vehicle's width, unknown is passable. With all weights 0, kAdmissibleShare of the
 * length over the best speed of a pattern set is an admissible heuristic of the time to go.
 * Settled bucket by bucket, only as far as needed around the vehicle. */
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
  /// Recomputes in place. If interrupted, unsettled cells get the length of the farthest settled
  /// one.
  void compute(const ClearanceSource& map, const Goal& goal, const Eigen::Vector2d& p_vehicle,
               const std::vector<Detour>& detours, const DistanceFieldConfig& config,
               const Interruption& interruption = {});

  /// Length from a point to the edge of the goal's tolerance [m]; infinite if there is no path.
  /** Interpolated between coarse cells. On blocked ground: from the best cell within half a metre.
   */
  double length(const Eigen::Vector2d& p_map) const;

  /// Length at a point, and the direction of the path.
  struct Sample {
    float length = 0.0F;   ///< [m] infinite if there is no path
    float along_x = 0.0F;  ///< unit vector towards the goal; zero if unknown
    float along_y = 0.0F;
  };
  /// Faster than length(): extrapolated from one cell with its slope. Differs by at most
  /// cellSlack() from the interpolation.
  Sample sample(double x, double y) const {
    const RimmedCells::Place at = cells_.placeOf(x, y);
    if (!(settled_[at.cell] < kOpen)) return {static_cast<float>(length({x, y})), 0.0F, 0.0F};
    const Slope& slope = slopes_[at.cell];
    const float gone = slope.step * (slope.along_x * at.dx + slope.along_y * at.dy);
    return {std::max(0.0F, settled_[at.cell] - gone), slope.along_x, slope.along_y};
  }
  /// Whether sample() avoids length(), which is slow and needed mostly on blocked ground.
  bool isSettled(double x, double y) const { return settled_[cells_.placeOf(x, y).cell] < kOpen; }
  /// Possible error of the length at a point, because cells are coarse [m].
  double cellSlack() const { return 0.75 * cells_.size; }
  /// Length from a point until the path to the goal enters unknown ground [m]; capped at 10 m.
  double untilUnknown(const Eigen::Vector2d& p_map) const;
  /// Unit vector along the path to the goal at a point; zero at the goal or without a path.
  Eigen::Vector2d direction(const Eigen::Vector2d& p_map) const;
  /// At most `count` points down the path to the goal, a step apart.
  std::vector<Eigen::Vector2d> descend(const Eigen::Vector2d& p_map, double step, int count) const;
  /// Why there is no path from the vehicle to the goal, with unknown ground passable; empty if
  /// there is one.
  const std::string& problem() const { return problem_; }
  bool unreachable() const { return !problem_.empty(); }
  /// Whether obstacles are the reason.
  bool enclosed() const { return enclosed_; }
  /// Without a path to the goal: the point nearest to it that the vehicle can reach. nullopt if the
  /// vehicle stands on blocked ground, or nothing was computed.
  /** `before`, the previous choice, is kept unless another point is nearer by kMuchNearer: the
   * vehicle must not alternate between two equally good points. */
  std::optional<Eigen::Vector2d> nearestWithinReach(
      const Eigen::Vector2d& p_vehicle, const Eigen::Vector2d& p_goal,
      const std::optional<Eigen::Vector2d>& before = std::nullopt) const;
  /// Whether a point lies in the computed area, at least `reach` [m] from its border.
  bool covers(const Eigen::Vector2d& p_map, double reach) const;
  /// Number of computed coarse cells, for measurements.
  int filled() const { return filled_; }

 private:
  class March;
  static constexpr float kUnknownCap = 10.0F;  // [m]
  static constexpr float kOpen = std::numeric_limits<float>::infinity();
  static constexpr float kNoWay = kOpen;
  /// Gradient of the length around a cell.
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

  RimmedCells cells_;                  // blocked in the border
  std::vector<float> slowness_;        // [m of path per m]; infinite where blocked or settled
  std::vector<float> tentative_;       // [m] shortest so far
  std::vector<float> settled_{kOpen};  // [m] final; infinite before
  std::vector<Slope> slopes_;          // valid for settled cells only
  std::vector<uint8_t> unknown_;
  float cut_ = 0.0F;  // nothing was computed beyond this length
  bool cut_short_ = false;
  std::string problem_;
  bool enclosed_ = false;
  int filled_ = 0;
};

}  // namespace tread::planner
