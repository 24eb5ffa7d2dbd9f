// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "tools/lab/missions/mission_world.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>

#include "common/config/config_reader.hpp"
#include "modules/simulator/simulator_files.hpp"
#include "modules/simulator/simulator_node.hpp"

namespace tread::missions {
namespace {

using Eigen::Vector2d;

/// Radius around start and goal that stays free, for turning on the spot.
constexpr double kFreeRadius = 2.2;

/// A random generator with the same numbers on every platform (the standard's distributions
/// differ).
class Rng {
 public:
  explicit Rng(uint64_t seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1.0p-53;
  }
  int below(int count) { return static_cast<int>(engine_() % static_cast<uint64_t>(count)); }
  bool chance(double probability) { return between(0.0, 1.0) < probability; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }

 private:
  std::mt19937_64 engine_;
};

/// Obstacles in a frame with the start at the origin and the goal on the x axis.
struct Layout {
  FootprintSize robot;  ///< its outline
  double length = 0.0;
  std::vector<sim::Obstacle> obstacles;
};

double pointToSegment(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d ab = b - a;
  const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return (p - a - t * ab).norm();
}

/// Distance from a point to an obstacle; 0 inside.
double distanceTo(const sim::Obstacle& obstacle, const Vector2d& p) {
  if (obstacle.isDisc()) return std::max(0.0, (p - obstacle.centre).norm() - obstacle.radius);
  double nearest = 1e9;
  bool inside = true;
  for (size_t i = 0; i < obstacle.corners.size(); ++i) {
    const Vector2d& a = obstacle.corners[i];
    const Vector2d& b = obstacle.corners[(i + 1) % obstacle.corners.size()];
    nearest = std::min(nearest, pointToSegment(p, a, b));
    const Vector2d ab = b - a;
    if (ab.x() * (p - a).y() - ab.y() * (p - a).x() < 0.0) inside = false;
  }
  return inside ? 0.0 : nearest;
}

/// Distance between two obstacles; 0 if they touch.
double gapBetween(const sim::Obstacle& a, const sim::Obstacle& b) {
  if (a.isDisc()) return std::max(0.0, distanceTo(b, a.centre) - a.radius);
  if (b.isDisc()) return gapBetween(b, a);
  // The shortest distance of disjoint convex polygons is at a corner of one of them.
  double gap = 1e9;
  for (const Vector2d& corner : a.corners) gap = std::min(gap, distanceTo(b, corner));
  for (const Vector2d& corner : b.corners) gap = std::min(gap, distanceTo(a, corner));
  return gap;
}

bool nearEnds(const Layout& layout, const sim::Obstacle& obstacle) {
  return distanceTo(obstacle, {0.0, 0.0}) < kFreeRadius ||
         distanceTo(obstacle, {layout.length, 0.0}) < kFreeRadius;
}

/// Adds a group of obstacles unless one is near start or goal, or closer than `gap` [m] to another
/// obstacle.
bool addApart(Layout& layout, const std::vector<sim::Obstacle>& parts, double gap) {
  for (const sim::Obstacle& part : parts) {
    if (nearEnds(layout, part)) return false;
    for (const sim::Obstacle& other : layout.obstacles)
      if (gapBetween(part, other) < gap) return false;
  }
  layout.obstacles.insert(layout.obstacles.end(), parts.begin(), parts.end());
  return true;
}

/// A wall across the way with one gap off the straight line.
void addWall(Layout& layout, Rng& rng, double x) {
  const double yaw = kPi / 2 + rng.between(-0.3, 0.3);
  const double gap = rng.between(narrowestGap(layout.robot), narrowestGap(layout.robot) + 0.92);
  const double gap_at = rng.sign() * rng.between(1.6, 4.5);
  const double half = rng.between(7.0, 11.0);
  const double thickness = rng.between(0.25, 0.5);
  const double first = gap_at - gap / 2 + half;
  const double second = half - gap_at - gap / 2;
  const Pose2 middle{x, 0.0, yaw};
  const Pose2 low = middle * Pose2{-half + first / 2, 0.0, 0.0};
  const Pose2 high = middle * Pose2{half - second / 2, 0.0, 0.0};
  const double height = rng.between(0.9, 1.6);
  addApart(layout,
           {sim::boxObstacle(low, first, thickness, height),
            sim::boxObstacle(high, second, thickness, height)},
           2.0);
}

/// A pocket on the straight line that opens towards the start.
void addPocket(Layout& layout, Rng& rng, double x) {
  const double width = rng.between(3.0, 5.0);
  const double depth = rng.between(2.0, 4.0);
  const Pose2 back{x, rng.between(-0.8, 0.8), rng.between(-0.3, 0.3)};
  const double height = rng.between(0.9, 1.6);
  const double thickness = 0.3;
  // The sides overlap the back by its thickness, which leaves no slit.
  addApart(layout,
           {sim::boxObstacle(back, thickness, width, height),
            sim::boxObstacle(back * Pose2{-depth / 2, width / 2 - thickness / 2, 0.0},
                             depth + thickness, thickness, height),
            sim::boxObstacle(back * Pose2{-depth / 2, -width / 2 + thickness / 2, 0.0},
                             depth + thickness, thickness, height)},
           1.5);
}

void addBoulders(Layout& layout, Rng& rng) {
  const int wanted = 20 + rng.below(26);
  for (int i = 0, tries = 0; i < wanted && tries < 600; ++tries) {
    const Vector2d at(rng.between(2.0, layout.length + 2.0), rng.between(-9.0, 9.0));
    const double height = rng.between(0.8, 2.0);
    const sim::Obstacle boulder =
        rng.chance(0.6) ? sim::discObstacle(at, rng.between(0.15, 0.7), height)
                        : sim::boxObstacle({at.x(), at.y(), rng.between(0.0, kPi)},
                                           rng.between(0.4, 1.6), rng.between(0.3, 1.0), height);
    if (addApart(layout, {boulder}, narrowestGap(layout.robot))) ++i;
  }
}

bool lineBlocked(const Layout& layout) {
  for (double x = 0.0; x <= layout.length; x += 0.1)
    for (const sim::Obstacle& obstacle : layout.obstacles)
      if (sim::penetrationOf(obstacle, {layout.robot.length(), 2.0 * layout.robot.half_width},
                             {x, 0.0, 0.0}) > 0.0)
        return true;
  return false;
}

/// Whether a disc of half the robot's width plus 12 cm finds a path: a necessary condition for the
/// footprint.
bool hasWay(const Layout& layout) {
  constexpr double kCell = 0.2;
  constexpr double kSide = 14.0;
  const int width = static_cast<int>((layout.length + 16.0) / kCell);
  const int height = static_cast<int>(2.0 * kSide / kCell);
  const auto centre = [&](int x, int y) {
    return Vector2d(-8.0 + (x + 0.5) * kCell, -kSide + (y + 0.5) * kCell);
  };
  std::vector<char> closed(static_cast<size_t>(width * height), 0);
  const auto blocked = [&](int x, int y) {
    for (const sim::Obstacle& obstacle : layout.obstacles)
      if (distanceTo(obstacle, centre(x, y)) < layout.robot.half_width + 0.12) return true;
    return false;
  };
  const int start_x = static_cast<int>(8.0 / kCell), start_y = height / 2;
  const int goal_x = static_cast<int>((layout.length + 8.0) / kCell);
  std::deque<std::pair<int, int>> open{{start_x, start_y}};
  closed[static_cast<size_t>(start_y * width + start_x)] = 1;
  constexpr int kSteps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  while (!open.empty()) {
    const auto [x, y] = open.front();
    open.pop_front();
    if (x == goal_x && y == start_y) return true;
    for (const auto& step : kSteps) {
      const int nx = x + step[0], ny = y + step[1];
      if (nx < 0 || ny < 0 || nx >= width || ny >= height) continue;
      char& seen = closed[static_cast<size_t>(ny * width + nx)];
      if (seen || blocked(nx, ny)) continue;
      seen = 1;
      open.emplace_back(nx, ny);
    }
  }
  return false;
}

Layout drawLayout(Rng& rng, const FootprintSize& robot, double shortest) {
  Layout layout;
  layout.robot = robot;
  layout.length = rng.between(shortest, 1.68 * shortest);
  const int barriers = 1 + rng.below(3);
  for (int i = 0; i < barriers; ++i) {
    const double share = (i + rng.between(0.3, 0.7)) / barriers;
    const double x = 5.0 + share * (layout.length - 10.0);
    if (rng.chance(0.65)) {
      addWall(layout, rng, x);
    } else {
      addPocket(layout, rng, x);
    }
  }
  addBoulders(layout, rng);
  return layout;
}

void addSurfaces(MissionWorld& world, Rng& rng, double length, const Pose2& T_map_way) {
  const std::vector<std::string> names{"cinder", "tarmac", "grass", "gravel"};
  const int changes = 1 + rng.below(3);
  world.surface_changes = changes;
  int present = rng.below(4);
  world.description.base_surface = names[static_cast<size_t>(present)];
  for (int i = 0; i < changes; ++i) {
    present = (present + 1 + rng.below(3)) % 4;
    const double x = length * (i + 1 + rng.between(-0.15, 0.15)) / (changes + 1);
    const double tilt = rng.between(-0.2, 0.2);
    const Pose2 border = T_map_way * Pose2{x, 0.0, tilt};
    sim::SurfaceRegion strip;
    strip.surface = names[static_cast<size_t>(present)];
    const double far = std::max(120.0, 80.0 + length);
    for (const Vector2d& corner :
         {Vector2d(0, -80), Vector2d(far, -80), Vector2d(far, 80), Vector2d(0, 80)})
      strip.corners.push_back(border * corner);
    world.description.regions.push_back(strip);
  }
}

/// Covers each border with a stretch; on the straight line the stretches are disjoint.
void addStretches(MissionWorld& world, Rng& rng, const WorldKind& kind) {
  world.description.surfaces = kind.surfaces;
  if (kind.between.empty()) return;
  const double share = world.straight_line / (world.surface_changes + 1);
  for (size_t i = 0, borders = world.description.regions.size(); i < borders; ++i) {
    const std::vector<Vector2d>& behind = world.description.regions[i].corners;
    world.description.regions.push_back(sim::stripRegion(
        kind.between, behind.front(), behind.back(), share * rng.between(0.4, 0.65)));
  }
  world.surface_changes *= 2;
}

/// Two or three bumpy stretches, as wide as the obstacle field, so that no path avoids them.
void addRoughGround(MissionWorld& world, Rng& rng, const WorldKind& kind, const Pose2& T_map_way) {
  if (!kind.rough) return;
  const int stretches = 2 + rng.below(2);
  const double share = world.straight_line / stretches;
  for (int i = 0; i < stretches; ++i) {
    const double length = share * kind.rough_share;
    const double from = share * i + rng.between(0.0, share - length);
    sim::RoughRegion region = *kind.rough;
    region.seed = world.seed * 8 + static_cast<uint64_t>(i);
    for (const Vector2d& corner : {Vector2d(from, -14.0), Vector2d(from + length, -14.0),
                                   Vector2d(from + length, 14.0), Vector2d(from, 14.0)})
      region.corners.push_back(T_map_way * corner);
    world.description.rough.push_back(region);
  }
}

void addTerrain(MissionWorld& world, Rng& rng) {
  const int waves = 1 + rng.below(3);
  for (int i = 0; i < waves; ++i) {
    sim::TerrainWave wave;
    const double k = 2.0 * kPi / rng.between(14.0, 35.0);
    const double direction = rng.between(0.0, 2.0 * kPi);
    wave.k = {k * std::cos(direction), k * std::sin(direction)};
    // At most 5 % slope in total.
    wave.amplitude = rng.between(0.0, 0.05) / waves / k;
    wave.phase = rng.between(0.0, 2.0 * kPi);
    world.description.terrain.waves.push_back(wave);
  }
}

sim::Obstacle moved(const sim::Obstacle& obstacle, const Pose2& T_map_way) {
  sim::Obstacle result = obstacle;
  result.centre = T_map_way * obstacle.centre;
  for (Vector2d& corner : result.corners) corner = T_map_way * corner;
  return result;
}

}  // namespace

MissionWorld makeMissionWorld(uint64_t seed, const FootprintSize& robot, double shortest,
                              const WorldKind& kind) {
  // Neighbouring seeds would give similar generators: spread them first (Weyl constant).
  Rng rng(seed * 0x9e3779b97f4a7c15ull + 1);
  MissionWorld world;
  world.seed = seed;
  Layout layout = drawLayout(rng, robot, shortest);
  const bool may_be_open = rng.chance(0.1);
  while (!hasWay(layout) || (!may_be_open && !lineBlocked(layout)))
    layout = drawLayout(rng, robot, shortest);
  const Pose2 T_map_way{0.0, 0.0, rng.between(-kPi, kPi)};
  world.T_map_start = T_map_way * Pose2{0.0, 0.0, rng.between(-0.8, 0.8)};
  world.T_map_goal = T_map_way * Pose2{layout.length, 0.0, 0.0};
  world.T_map_start.yaw = wrapAngle(world.T_map_start.yaw);
  world.T_map_goal.yaw = wrapAngle(world.T_map_goal.yaw);
  world.straight_line = layout.length;
  world.description.name = "mission " + std::to_string(seed);
  const double reach = layout.length + 30.0;
  world.description.bounds = {{-reach, -reach}, {reach, reach}};
  world.line_blocked = lineBlocked(layout);
  for (const sim::Obstacle& obstacle : layout.obstacles)
    world.description.obstacles.push_back(moved(obstacle, T_map_way));
  addSurfaces(world, rng, layout.length, T_map_way);
  addTerrain(world, rng);
  addStretches(world, rng, kind);
  addRoughGround(world, rng, kind, T_map_way);
  return world;
}

MissionWorld readMissionWorld(const std::string& simulator_file,
                              const Eigen::Vector2d& p_map_goal) {
  ConfigReader reader = ConfigReader::fromFile(simulator_file);
  const sim::SimulatorConfig config = sim::readSimulatorConfig(reader);
  MissionWorld world;
  world.seed = config.settings.robot.seed;
  world.T_map_start = config.settings.robot.start;
  world.T_map_goal = {p_map_goal.x(), p_map_goal.y(), 0.0};
  world.straight_line = (p_map_goal - world.T_map_start.position()).norm();
  world.description = sim::readWorld(config.world);
  return world;
}

}  // namespace tread::missions
