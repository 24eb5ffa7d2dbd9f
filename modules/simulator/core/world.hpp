// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "modules/simulator/core/obstacle.hpp"
#include "modules/simulator/core/rough_ground.hpp"
#include "modules/simulator/core/terrain.hpp"

namespace tread::sim {

/// A region of ground: a simple polygon, convex or not.
struct SurfaceRegion {
  std::string surface;                   ///< by name
  std::vector<Eigen::Vector2d> corners;  ///< p_map [m]
};

/// A straight strip of ground between two points, `width` wide [m].
SurfaceRegion stripRegion(const std::string& surface, const Eigen::Vector2d& from,
                          const Eigen::Vector2d& to, double width);

/// A complete world, as described by the user.
struct WorldDescription {
  std::string name;
  Extent bounds{{-20.0, -20.0}, {20.0, 20.0}};  ///< where missions take place [m]
  std::string base_surface = "grass";           ///< outside of all regions
  /// In addition to the built-in ones; the same name replaces
  std::vector<SurfaceParameters> surfaces;
  std::vector<SurfaceRegion> regions;  ///< later ones cover earlier ones
  Terrain terrain;
  std::vector<RoughRegion> rough;  ///< bumps on the terrain; overlapping ones add up
  std::vector<Obstacle> obstacles;
};

/// Why a description is invalid; nullopt if it is valid.
std::optional<std::string> worldFault(const WorldDescription& description);

/// A contact between the footprint and an obstacle.
struct Collision {
  size_t obstacle = 0;       ///< index in the description
  double penetration = 0.0;  ///< [m], above 0
};

/// Ground, terrain and obstacles, prepared for fast queries.
class World {
 public:
  /// Throws std::invalid_argument with worldFault()'s message if the description is invalid.
  explicit World(WorldDescription description);

  /// The surface at a point; the reference lives as long as the world.
  const SurfaceParameters& surface(const Eigen::Vector2d& p_map) const;

  /// Height of the ground [m].
  double height(const Eigen::Vector2d& p_map) const {
    return description_.terrain.height(p_map) + rough_.height(p_map);
  }
  /// The plane that supports a rigid vehicle: the terrain's at the body origin, and the bumps'
  /// under the whole contact of both tracks.
  Bearing bearing(const Pose2& T_map_body, const FootprintSize& contact) const;
  /// Whether a point is on ground with bumps.
  bool isRough(const Eigen::Vector2d& p_map) const { return rough_.covers(p_map); }

  /// Distance along a ray (unit direction, map frame) to the first obstacle or ground; nullopt if
  /// there is none within range.
  std::optional<double> castRay(const Eigen::Vector3d& start, const Eigen::Vector3d& direction,
                                double range) const;

  /// The deepest contact of a rectangle at a pose with any obstacle. Used to detect collisions in
  /// missions.
  std::optional<Collision> collision(const Rectangle& rectangle, const Pose2& T_map_body) const;

  const WorldDescription& description() const { return description_; }

 private:
  /// A beam over the plane: height z + slope x horizontal distance.
  struct Beam {
    Eigen::Vector2d start;
    Eigen::Vector2d direction;  ///< unit
    double z = 0.0;
    double slope = 0.0;
  };
  double obstacleDistance(const Beam& beam, double range) const;
  double groundDistance(const Beam& beam, double range) const;

  struct Patch {
    size_t surface;  ///< index in surfaces_
    Extent extent;
  };
  size_t surfaceIndex(const std::string& name) const;

  WorldDescription description_;
  std::vector<SurfaceParameters> surfaces_;
  size_t base_surface_ = 0;
  std::vector<Patch> patches_;  ///< one per region
  std::vector<double> tops_;    ///< z_map of each obstacle's top [m]
  ObstacleGrid grid_;
  HeightTable heights_;  ///< empty on flat ground
  RoughGround rough_;
};

}  // namespace tread::sim
