// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include "common/grid/grid.hpp"
#include "modules/planner/core/map/collision_checker.hpp"
#include "modules/planner/core/map/distance_to_goal.hpp"

namespace tread::planner::testkit {

/// An upright box on the ground: centre, heading and half sizes [m].
struct Box {
  Pose2 T_map_box;
  double half_length = 0.5;
  double half_width = 0.5;
};

/// The true place of a test with its obstacles.
class Playground {
 public:
  void add(const Box& box) { boxes_.push_back(box); }
  /// A wall along the line between two points, `thickness` [m] thick.
  void addWall(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double thickness = 0.2);
  const std::vector<Box>& boxes() const { return boxes_; }

  bool isObstacle(const Eigen::Vector2d& p_map) const;
  /// Least distance between the footprint and any box [m]; 0 or less at a contact.
  double clearance(const FootprintSize& size, const Pose2& T_map_body) const;
  /// The truth as a grid over a rectangle: any obstacle in a cell blocks it.
  Grid paint(double cell_size, const Eigen::Vector2d& lower, const Eigen::Vector2d& upper) const;
  /// Whether a disc of a radius [m] can move from one point to the other.
  bool connected(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double radius) const;

 private:
  std::vector<Box> boxes_;
};

/// The boxes in the range of a range finder at a position.
class Sight {
 public:
  Sight(const Playground& ground, const Eigen::Vector2d& p_map, double range);

  /// Distance to the nearest box along a ray; the range if there is none.
  double cast(double angle) const;

 private:
  struct Near {
    Box box;
    Eigen::Vector2d p_box;  ///< the range finder in the box's own frame
  };

  double range_;
  std::vector<Near> near_;
};

/// A place and a task in it.
struct Mission {
  Playground ground;
  Pose2 T_map_start;
  Goal goal;
};

/// A walled yard with cross walls, whose gaps may be as narrow as the footprint plus 0.4 m, boxes
/// and a pocket.
/** The goal is at least 25 m away, and a path of that width exists. */
Mission randomMission(uint64_t seed);

/// Tiles of a grid, as published by mapping.
std::vector<Tile> tilesOf(const Grid& grid, int tile_cells, int64_t utime);

/// A scanning laser and a persistent map: free where beams passed, obstacle at their ends.
class ToyMapping {
 public:
  explicit ToyMapping(uint64_t seed) : random_(seed) {}

  /// Scans from a pose and returns the changed tiles, or any tile if none changed.
  std::vector<Tile> scan(const Playground& ground, const Pose2& T_map_body, int64_t utime);

  static constexpr double kCell = 0.1;
  static constexpr int kTileCells = 32;

 private:
  void note(CellIndex cell, int evidence);

  std::mt19937_64 random_;
  std::map<std::pair<int, int>, std::vector<int8_t>> evidence_;
  std::map<std::pair<int, int>, Tile> tiles_;
  std::map<std::pair<int, int>, bool> touched_;
};

}  // namespace tread::planner::testkit
