// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/bench/limits/limit_world.hpp"

#include <cmath>
#include <random>

namespace tread::limits {
namespace {

using Eigen::Vector2d;

constexpr double kShortest = 14.0;   // [m]
constexpr double kFreeAround = 2.5;  // [m] around start and goal
constexpr double kDegree = kPi / 180.0;

class Draw {
 public:
  explicit Draw(uint64_t seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1.0p-53;
  }
  bool chance(double probability) { return between(0.0, 1.0) < probability; }
  int below(int count) { return static_cast<int>(engine_() % static_cast<uint64_t>(count)); }

 private:
  std::mt19937_64 engine_;
};

/// Frame of the way: origin at the start, x axis towards the goal.
Pose2 wayOf(const missions::MissionWorld& mission) {
  const Vector2d way = mission.T_map_goal.position() - mission.T_map_start.position();
  return {mission.T_map_start.x, mission.T_map_start.y, std::atan2(way.y(), way.x())};
}

Fence yardAround(const Pose2& T_map_way, double length, bool outside, Draw& draw) {
  const double west = outside ? draw.between(-0.5, 3.0) : -draw.between(2.0, 5.0);
  const double east = length + draw.between(2.0, 5.0);
  const double south = -draw.between(5.0, 14.0), north = draw.between(5.0, 14.0);
  const double notch = draw.between(0.3, 0.7) * length;
  Fence yard{"yard", false, {}};
  for (const Vector2d& corner :
       {Vector2d(west, south), Vector2d(east, south), Vector2d(east, north),
        Vector2d(notch + 1.0, north), Vector2d(notch, draw.between(0.2, 1.0) * north),
        Vector2d(notch - 1.0, north), Vector2d(west, north)})
    yard.corners.push_back(T_map_way * corner);
  return yard;
}

std::optional<Fence> pondOn(const Pose2& T_map_way, double length, int number, Draw& draw) {
  const Vector2d centre(draw.between(3.0, length - 3.0), draw.between(-2.0, 2.0));
  const int corners = 3 + draw.below(4);
  Fence pond{"pond " + std::to_string(number), true, {}};
  const double size = draw.between(0.4, 2.0);
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * kPi * (i + draw.between(-0.3, 0.3)) / corners;
    pond.corners.push_back(T_map_way *
                           Vector2d(centre + size * Vector2d(std::cos(angle), std::sin(angle))));
  }
  const bool near = roomAt(pond, T_map_way.position()) < kFreeAround ||
                    roomAt(pond, T_map_way * Vector2d(length, 0.0)) < kFreeAround;
  if (near || !faultOf(pond).empty()) return std::nullopt;
  return pond;
}

void addFences(LimitWorld& world, Draw& draw) {
  const Pose2 T_map_way = wayOf(world.mission);
  const double length = world.mission.straight_line;
  world.starts_outside = draw.chance(0.1);
  world.planner_knows = world.starts_outside || !draw.chance(0.25);
  world.fences.push_back(yardAround(T_map_way, length, world.starts_outside, draw));
  const int ponds = draw.below(3);
  for (int i = 0; i < ponds; ++i)
    if (const auto pond = pondOn(T_map_way, length, i, draw)) world.fences.push_back(*pond);
  if (!draw.chance(0.4)) return;
  world.surprise_s = draw.between(4.0, 16.0);
  world.surprise_ahead = draw.between(1.8, 4.0);
  world.surprise_width = draw.between(0.5, 4.0);
}

void addHills(LimitWorld& world, Draw& draw) {
  sim::Terrain& terrain = world.mission.description.terrain;
  const Pose2 T_map_way = wayOf(world.mission);
  const double length = world.mission.straight_line;
  const int hills = 1 + draw.below(4);
  for (int i = 0; i < hills; ++i) {
    sim::TerrainBump bump;
    bump.centre = T_map_way * Vector2d(draw.between(3.0, length - 3.0), draw.between(-4.0, 4.0));
    bump.radius = draw.between(2.0, 5.0);
    // The steepest place is at its radius.
    bump.height = std::tan(draw.between(8.0, 40.0) * kDegree) * bump.radius * std::exp(0.5);
    if (draw.chance(0.4)) bump.height = -bump.height;
    terrain.bumps.push_back(bump);
    for (const Pose2& end : {world.mission.T_map_start, world.mission.T_map_goal})
      if (terrain.gradient(end.position()).norm() > std::tan(8.0 * kDegree)) {
        terrain.bumps.pop_back();
        break;
      }
  }
}

}  // namespace

LimitWorld limitWorld(uint64_t seed, Kind kind, const FootprintSize& outline) {
  LimitWorld world;
  world.mission = missions::makeMissionWorld(seed, outline, kShortest);
  Draw draw(seed * 0x9e3779b97f4a7c15ull + 77);
  if (kind == Kind::kFences)
    addFences(world, draw);
  else
    addHills(world, draw);
  return world;
}

}  // namespace tread::limits
