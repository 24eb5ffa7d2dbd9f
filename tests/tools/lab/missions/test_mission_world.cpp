// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <set>

#include "tools/lab/missions/mission.hpp"

using namespace tread;
using namespace tread::missions;

TEST_CASE("a mission's world is the same for the same seed and another for another") {
  const MissionWorld a = makeMissionWorld(5, {0.65, 0.65, 0.34}),
                     b = makeMissionWorld(5, {0.65, 0.65, 0.34}),
                     c = makeMissionWorld(6, {0.65, 0.65, 0.34});
  REQUIRE(a.description.obstacles.size() == b.description.obstacles.size());
  REQUIRE(a.T_map_goal.x == b.T_map_goal.x);
  REQUIRE(a.T_map_goal.x != c.T_map_goal.x);
}

TEST_CASE("mission worlds are hard: far goals, blocked lines, changing ground, and still sound") {
  int blocked = 0, narrow = 0;
  constexpr int kWorlds = 60;
  for (uint64_t seed = 1; seed <= kWorlds; ++seed) {
    CAPTURE(seed);
    const MissionWorld world = makeMissionWorld(seed, {0.65, 0.65, 0.34});
    REQUIRE((world.T_map_goal.position() - world.T_map_start.position()).norm() >= 25.0);
    blocked += world.line_blocked ? 1 : 0;
    const auto& regions = world.description.regions;
    REQUIRE(regions.size() >= 1);
    REQUIRE(regions.size() <= 3);
    std::string before = world.description.base_surface;
    for (const sim::SurfaceRegion& region : regions) {
      REQUIRE(region.surface != before);
      before = region.surface;
    }
    REQUIRE(world.description.terrain.steepestSlope() <= 0.051);
    REQUIRE_FALSE(sim::worldFault(world.description));
    const sim::World real(world.description);
    // The straight line crosses as many borders as the world states.
    int changes = 0;
    std::string under = real.surface(world.T_map_start.position()).name;
    for (double share = 0.0; share <= 1.0; share += 0.002) {
      const Eigen::Vector2d p =
          (1.0 - share) * world.T_map_start.position() + share * world.T_map_goal.position();
      if (real.surface(p).name == under) continue;
      under = real.surface(p).name;
      ++changes;
    }
    REQUIRE(changes == world.surface_changes);
    REQUIRE(changes >= 1);
    REQUIRE(changes <= 3);
    for (double yaw = 0.0; yaw < 6.3; yaw += 0.3) {
      const Pose2 start{world.T_map_start.x, world.T_map_start.y, yaw};
      const Pose2 goal{world.T_map_goal.x, world.T_map_goal.y, yaw};
      REQUIRE_FALSE(real.collision({1.30, 0.68}, start));
      REQUIRE_FALSE(real.collision({1.30, 0.68}, goal));
    }
    narrow += world.description.obstacles.size() > 15 ? 1 : 0;
  }
  REQUIRE(blocked >= kWorlds * 8 / 10);
  REQUIRE(narrow >= kWorlds / 2);
}

TEST_CASE("walls have gaps from the footprint plus 0.4 m up") {
  // A wall consists of two collinear boxes; its gap is the distance between their nearest corners.
  double narrowest = 1e9;
  for (uint64_t seed = 1; seed <= 80; ++seed) {
    const MissionWorld world = makeMissionWorld(seed, {0.65, 0.65, 0.34});
    const auto& obstacles = world.description.obstacles;
    for (size_t i = 0; i < obstacles.size(); ++i)
      for (size_t j = i + 1; j < obstacles.size(); ++j) {
        if (obstacles[i].isDisc() || obstacles[j].isDisc()) continue;
        double gap = 1e9;
        for (const auto& a : obstacles[i].corners)
          for (const auto& b : obstacles[j].corners) gap = std::min(gap, (a - b).norm());
        // Parts of a pocket overlap; all other obstacles keep their distance.
        if (gap > 0.5) narrowest = std::min(narrowest, gap);
      }
  }
  REQUIRE(narrowest >= narrowestGap({0.65, 0.65, 0.34}) - 1e-9);
  REQUIRE(narrowest < 1.2);
}
