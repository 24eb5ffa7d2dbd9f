// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "modules/planner/core/map/clearance_map.hpp"
#include "modules/planner/core/map/collision_checker.hpp"
#include "modules/planner/core/map/distance_to_goal.hpp"

namespace tread::planner {

/// A number of at least 0 in words that people read, such as "3.5".
inline std::string withTenths(double value) {
  const auto tenths = std::lround(10.0 * value);
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10);
}

/// How the planner keeps and interprets the map.
struct PlanningMapConfig {
  FootprintSize footprint;
  Margins margins;
  ClearanceMapConfig clearance;
  DistanceFieldConfig field;
  double window = 24.0;             ///< [m] side of the square in which collisions are checked
  int64_t window_period = 100'000;  ///< [us] least time between two cuts of that square
  int64_t field_period = 400'000;   ///< [us] least time between two updates of the distance
  bool unknown_blocks = true;       ///< whether unknown ground may not be driven on
  bool come_close = false;          ///< to goals that obstacles enclose, instead of standing
};

/// The received map, and what is derived from it on demand: collision checker and distance to goal.
class PlanningMap {
 public:
  explicit PlanningMap(const PlanningMapConfig& config) : config_(config) {}

  /// Takes a tile; a map of another cell size replaces what is there. False if the tile is
  /// malformed.
  bool put(Tile tile, double cell_size, int tile_cells);
  bool empty() const { return !map_ || map_->empty(); }
  /// [us] of the newest scan in the map; 0 if there is none.
  int64_t newestUtime() const { return map_ ? map_->newestUtime() : 0; }

  /// Updates the collision checker if the map changed or the vehicle moved on. Needs a map.
  /** Unknown ground under the vehicle becomes free: it stands there. */
  void updateCollisionChecker(const Pose2& T_map_body, int64_t now);
  /// Updates the distance to the goal. Needs updateCollisionChecker().
  void updateDistance(const Pose2& T_map_body, const Goal& goal, int64_t now);
  /// Makes a place more expensive until the goal changes.
  void addDetour(const Eigen::Vector2d& p_map);
  /// The narrowest place a little way ahead becomes a detour; after `most` all are forgotten.
  void addDetourAhead(const Eigen::Vector2d& p_vehicle, int most);
  size_t detours() const { return detours_.size(); }
  void forgetDetours();

  const CollisionChecker& collisionChecker() const { return *checker_; }
  const DistanceToGoal& distanceToGoal() const { return distance_to_goal_; }
  /// What to drive to: the goal, or with come_close the reachable place nearest to an unreachable
  /// one. Needs updateDistance().
  const Goal& target() const { return target_; }
  /// Why the target is not the goal, in words; empty if it is.
  const std::string& goalSubstitutionReason() const { return goal_substitution_reason_; }
  const PlanningMapConfig& config() const { return config_; }

 private:
  void assumeFreeUnder(const Pose2& T_map_body);
  bool sameGoal(const Goal& goal) const;
  void substituteGoal(const Eigen::Vector2d& p_vehicle,
                      const std::optional<Eigen::Vector2d>& before);

  PlanningMapConfig config_;
  std::optional<ClearanceMap> map_;
  std::optional<CollisionChecker> checker_;
  Eigen::Vector2d p_window_{0.0, 0.0};
  int64_t window_revision_ = -1;
  int64_t window_time_ = 0;
  DistanceToGoal distance_to_goal_;
  std::optional<Goal> field_goal_;
  Goal target_;
  std::string goal_substitution_reason_;
  int64_t field_revision_ = -1;
  Eigen::Vector2d p_field_{0.0, 0.0};
  int64_t field_time_ = 0;
  bool detours_changed_ = false;
  std::vector<Detour> detours_;
};

}  // namespace tread::planner
