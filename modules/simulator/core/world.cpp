// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/core/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace tread::sim {
namespace {

constexpr double kGridEdge = 0.5;        // [m]
constexpr double kHeightSpacing = 0.25;  // [m]
constexpr double kHeightMargin = 5.0;    // of the height table around the bounds [m]
constexpr double kGroundStep = 0.05;     // least advance of a beam towards the ground [m]
constexpr double kFar = std::numeric_limits<double>::infinity();

/// The one of that name, or the end.
template <class Surfaces>
auto findNamed(Surfaces& surfaces, const std::string& name) {
  return std::find_if(surfaces.begin(), surfaces.end(),
                      [&](const SurfaceParameters& surface) { return surface.name == name; });
}

/// The built-in surfaces with the description's own, which replace those of the same name.
std::vector<SurfaceParameters> surfacesOf(const WorldDescription& description) {
  std::vector<SurfaceParameters> surfaces = builtInSurfaces();
  for (const SurfaceParameters& own : description.surfaces) {
    const auto same = findNamed(surfaces, own.name);
    if (same == surfaces.end())
      surfaces.push_back(own);
    else
      *same = own;
  }
  return surfaces;
}

bool named(const std::vector<SurfaceParameters>& surfaces, const std::string& name) {
  return findNamed(surfaces, name) != surfaces.end();
}

}  // namespace

SurfaceRegion stripRegion(const std::string& surface, const Eigen::Vector2d& from,
                          const Eigen::Vector2d& to, double width) {
  const Eigen::Vector2d along = (to - from).normalized();
  const Eigen::Vector2d side = Eigen::Vector2d(-along.y(), along.x()) * width / 2.0;
  return {surface, {from - side, to - side, to + side, from + side}};
}

std::optional<std::string> worldFault(const WorldDescription& description) {
  if (!(description.bounds.low.array() < description.bounds.high.array()).all())
    return "bounds: the low corner must lie below the high one";
  const std::vector<SurfaceParameters> surfaces = surfacesOf(description);
  if (!named(surfaces, description.base_surface))
    return "base surface: no surface is called '" + description.base_surface + "'";
  for (size_t i = 0; i < description.regions.size(); ++i) {
    const SurfaceRegion& region = description.regions[i];
    const std::string where = "region " + std::to_string(i + 1) + ": ";
    if (!named(surfaces, region.surface))
      return where + "no surface is called '" + region.surface + "'";
    if (region.corners.size() < 3) return where + "needs at least three corners";
  }
  for (size_t i = 0; i < description.rough.size(); ++i) {
    const std::string fault = faultOf(description.rough[i]);
    if (!fault.empty()) return "rough region " + std::to_string(i + 1) + ": " + fault;
  }
  for (size_t i = 0; i < description.obstacles.size(); ++i) {
    const auto fault = obstacleFault(description.obstacles[i]);
    if (fault) return "obstacle " + std::to_string(i + 1) + ": " + *fault;
  }
  return std::nullopt;
}

World::World(WorldDescription description)
    : description_(std::move(description)),
      surfaces_(surfacesOf(description_)),
      rough_(description_.rough) {
  if (const auto fault = worldFault(description_))
    throw std::invalid_argument("world '" + description_.name + "': " + *fault);
  base_surface_ = surfaceIndex(description_.base_surface);
  for (const SurfaceRegion& region : description_.regions)
    patches_.push_back({surfaceIndex(region.surface), extentOf(region.corners)});
  for (const Obstacle& obstacle : description_.obstacles) {
    const Extent extent = extentOf(obstacle);
    tops_.push_back(height((extent.low + extent.high) / 2.0) + obstacle.height);
  }
  grid_ = ObstacleGrid(description_.obstacles, kGridEdge);
  if (!description_.terrain.flat()) {
    const Eigen::Vector2d margin(kHeightMargin, kHeightMargin);
    const Extent area{description_.bounds.low - margin, description_.bounds.high + margin};
    const Terrain& terrain = description_.terrain;
    heights_ = HeightTable([&](const auto& p) { return terrain.height(p); }, area, kHeightSpacing);
  }
}

size_t World::surfaceIndex(const std::string& name) const {
  return static_cast<size_t>(findNamed(surfaces_, name) - surfaces_.begin());
}

const SurfaceParameters& World::surface(const Eigen::Vector2d& p_map) const {
  for (size_t i = patches_.size(); i-- > 0;) {
    if (!patches_[i].extent.contains(p_map)) continue;
    if (insidePolygon(description_.regions[i].corners, p_map))
      return surfaces_[patches_[i].surface];
  }
  return surfaces_[base_surface_];
}

Bearing World::bearing(const Pose2& T_map_body, const FootprintSize& contact) const {
  const Eigen::Vector2d p_map = T_map_body.position();
  Bearing bearing{description_.terrain.height(p_map), description_.terrain.gradient(p_map)};
  if (rough_.empty()) return bearing;
  const Bearing bumps = rough_.bearing(T_map_body, contact);
  return {bearing.height + bumps.height, bearing.gradient + bumps.gradient};
}

std::optional<double> World::castRay(const Eigen::Vector3d& start, const Eigen::Vector3d& direction,
                                     double range) const {
  // Beams of a ground vehicle are never vertical; a vertical one would see the ground below.
  const double horizontal = std::max(direction.head<2>().norm(), 1e-9);
  const Beam beam{start.head<2>(), direction.head<2>() / horizontal, start.z(),
                  direction.z() / horizontal};
  const double reach = range * horizontal;
  const double obstacle = obstacleDistance(beam, reach);
  const double distance = std::min(obstacle, groundDistance(beam, std::min(obstacle, reach)));
  if (distance > reach) return std::nullopt;
  return distance / horizontal;
}

double World::obstacleDistance(const Beam& beam, double range) const {
  double nearest = kFar;
  grid_.visitAlong(beam.start, beam.direction, range, [&](uint32_t i, double cell_end) {
    const auto crossing = crossingOf(description_.obstacles[i], beam.start, beam.direction);
    if (!crossing) return false;
    double hit = crossing->enter;
    if (beam.z + beam.slope * hit > tops_[i]) {
      // Above the wall: a falling beam may still hit the roof.
      hit = beam.slope < 0.0 ? (tops_[i] - beam.z) / beam.slope : kFar;
      if (hit > crossing->leave) return false;
    }
    nearest = std::min(nearest, hit);
    return hit <= cell_end;
  });
  return nearest;
}

double World::groundDistance(const Beam& beam, double range) const {
  if (heights_.empty() && rough_.empty()) return beam.slope < 0.0 ? beam.z / -beam.slope : kFar;
  // Upper bound of the rate at which the gap to the ground shrinks: the beam may advance by gap /
  // closing.
  const double closing = heights_.steepestSlope() + rough_.steepestSlope() - beam.slope;
  if (closing <= 0.0) return kFar;
  double before = 0.0, gap_before = 0.0;
  for (double s = 0.0; before < range;) {
    const Eigen::Vector2d p_map = beam.start + s * beam.direction;
    const double ground = (heights_.empty() ? 0.0 : heights_.height(p_map)) + rough_.seen(p_map);
    const double gap = beam.z + beam.slope * s - ground;
    if (gap <= 0.0) return s <= 0.0 ? 0.0 : before + (s - before) * gap_before / (gap_before - gap);
    before = s;
    gap_before = gap;
    s += std::max(kGroundStep, gap / closing);
  }
  return kFar;
}

std::optional<Collision> World::collision(const Rectangle& rectangle,
                                          const Pose2& T_map_body) const {
  const double reach = std::hypot(rectangle.length, rectangle.width) / 2.0;
  const Eigen::Vector2d margin(reach, reach);
  std::optional<Collision> deepest;
  const Extent around{T_map_body.position() - margin, T_map_body.position() + margin};
  grid_.visitNear(around, [&](uint32_t i) {
    const double penetration = penetrationOf(description_.obstacles[i], rectangle, T_map_body);
    if (penetration <= 0.0) return;
    if (!deepest || penetration > deepest->penetration) deepest = Collision{i, penetration};
  });
  return deepest;
}

}  // namespace tread::sim
