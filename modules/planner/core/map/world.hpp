// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "modules/planner/core/map/cost_to_go.hpp"
#include "modules/planner/core/map/passage_map.hpp"
#include "modules/planner/core/map/surroundings.hpp"

namespace tread::planner {

/// What the planner makes of the map.
struct WorldConfig {
  FootprintSize footprint;
  Margins margins;
  PassageConfig passage;
  FieldConfig field;
  double window = 24.0;             ///< [m] side of the surroundings
  int64_t window_period = 100'000;  ///< [us] the surroundings are cut no more often than this
  int64_t field_period = 400'000;   ///< [us] the way to go is worked out no more often than this
  bool unknown_blocks = true;       ///< whether unknown ground may not be driven on
  bool come_close = false;          ///< to goals that obstacles enclose, instead of standing
};

/// The map as it was received, and what is derived from it when it is needed.
class World {
 public:
  explicit World(const WorldConfig& config) : config_(config) {}

  /// Takes a tile; a map of another cell size replaces what is there. False if the tile is
  /// malformed.
  bool put(Tile tile, double cell_size, int tile_cells);
  bool empty() const { return !map_ || map_->empty(); }
  /// [us] of the newest scan in the map; 0 if there is none.
  int64_t newestUtime() const { return map_ ? map_->newestUtime() : 0; }

  /// Brings the surroundings up to date, if the map changed or the vehicle went on. Needs a map.
  /** Unknown ground under the vehicle becomes free: it stands there. */
  void lookAround(const Pose2& T_map_body, int64_t now);
  /// Brings the way to the goal up to date. Needs lookAround().
  void lookAhead(const Pose2& T_map_body, const Goal& goal, int64_t now);
  /// Makes a place cost more from now on, until the goal changes.
  void addDetour(const Eigen::Vector2d& p_map);
  size_t detours() const { return detours_.size(); }
  void forgetDetours();

  const Surroundings& surroundings() const { return *surroundings_; }
  const CostToGo& costToGo() const { return cost_to_go_; }
  /// What to drive to: the goal, or the place nearest to one that cannot be reached, if that is
  /// wanted. Needs lookAhead().
  const Goal& aim() const { return aim_; }
  /// Why the aim is not the goal, in words; empty if it is.
  const std::string& detraction() const { return detraction_; }
  const WorldConfig& config() const { return config_; }

 private:
  void freeUnder(const Pose2& T_map_body);
  bool sameGoal(const Goal& goal) const;
  void comeClose(const Eigen::Vector2d& p_vehicle, const std::optional<Eigen::Vector2d>& before);

  WorldConfig config_;
  std::optional<PassageMap> map_;
  std::optional<Surroundings> surroundings_;
  Eigen::Vector2d p_window_{0.0, 0.0};
  int64_t window_revision_ = -1;
  int64_t window_time_ = 0;
  CostToGo cost_to_go_;
  std::optional<Goal> field_goal_;
  Goal aim_;
  std::string detraction_;
  int64_t field_revision_ = -1;
  Eigen::Vector2d p_field_{0.0, 0.0};
  int64_t field_time_ = 0;
  bool detours_changed_ = false;
  std::vector<Detour> detours_;
};

}  // namespace tread::planner
