// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <limits>
#include <random>

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "modules/simulator/core/world.hpp"
#include "tests/helpers.hpp"

namespace tread::sim {
namespace {

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1.0p-53;
}

/// Boxes and discs of all sizes and headings between -20 and 20 m.
std::vector<Obstacle> randomObstacles(Random& random, int count) {
  std::vector<Obstacle> obstacles;
  for (int i = 0; i < count; ++i) {
    const Pose2 pose{uniform(random, -20, 20), uniform(random, -20, 20), uniform(random, -3, 3)};
    const double size = uniform(random, 0.1, 2.5);
    const double height = uniform(random, 0.2, 2.0);
    obstacles.push_back(i % 2 == 0 ? boxObstacle(pose, size, uniform(random, 0.1, 2.5), height)
                                   : discObstacle(pose.position(), size / 2.0, height));
  }
  return obstacles;
}

/// Outline of an obstacle as a closed polygon; discs with many corners, slightly inside.
std::vector<Eigen::Vector2d> outlineOf(const Obstacle& obstacle) {
  if (!obstacle.isDisc()) return obstacle.corners;
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i < 180; ++i) {
    const double angle = 2.0 * kPi * i / 180;
    outline.push_back(obstacle.centre +
                      obstacle.radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return outline;
}

/// Distance to an edge along a ray by solving two equations; infinity without intersection.
double edgeDistance(const Eigen::Vector2d& start, const Eigen::Vector2d& direction,
                    const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  Eigen::Matrix2d system;
  system.col(0) = direction;
  system.col(1) = a - b;
  if (std::abs(system.determinant()) < 1e-12) return std::numeric_limits<double>::infinity();
  const Eigen::Vector2d solution = system.inverse() * (a - start);
  const bool hit = solution[0] >= 0.0 && solution[1] >= 0.0 && solution[1] <= 1.0;
  return hit ? solution[0] : std::numeric_limits<double>::infinity();
}

bool inside(const std::vector<Eigen::Vector2d>& outline, const Eigen::Vector2d& p) {
  double turned = 0.0;
  for (size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d a = outline[i] - p, b = outline[(i + 1) % outline.size()] - p;
    turned += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  }
  return std::abs(turned) > kPi;
}

WorldDescription flatWorld(std::vector<Obstacle> obstacles) {
  WorldDescription description;
  description.obstacles = std::move(obstacles);
  return description;
}

}  // namespace

TEST_CASE("level rays hit what a test of every edge of every obstacle hits") {
  Random random(1);
  const std::vector<Obstacle> obstacles = randomObstacles(random, 150);
  const World world(flatWorld(obstacles));
  int hits = 0;
  for (int trial = 0; trial < testing::effort(1000); ++trial) {
    const Eigen::Vector2d start(uniform(random, -24, 24), uniform(random, -24, 24));
    const double angle = uniform(random, -4, 4);
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    double wanted = std::numeric_limits<double>::infinity();
    for (const Obstacle& obstacle : obstacles) {
      if (obstacle.height < 0.5) continue;
      const Eigen::Vector2d middle = (extentOf(obstacle).low + extentOf(obstacle).high) / 2.0;
      if ((middle - start).norm() > 17.0) continue;
      const auto outline = outlineOf(obstacle);
      if (inside(outline, start)) wanted = 0.0;
      for (size_t i = 0; i < outline.size(); ++i) {
        wanted = std::min(
            wanted, edgeDistance(start, direction, outline[i], outline[(i + 1) % outline.size()]));
      }
    }
    const auto found =
        world.castRay({start.x(), start.y(), 0.5}, {direction.x(), direction.y(), 0.0}, 15.0);
    if (wanted > 15.0) {
      CHECK((!found || *found > 14.9));
      continue;
    }
    REQUIRE(found);
    CHECK(*found == Approx(wanted).margin(0.02));
    ++hits;
  }
  CHECK(hits > testing::effort(500));
}

TEST_CASE("low obstacles are seen over, and from above a falling beam meets their roof") {
  const World world(flatWorld({boxObstacle({5.0, 0.0, 0.0}, 2.0, 2.0, 0.4)}));
  const Eigen::Vector3d start(0.0, 0.0, 0.5);
  CHECK_FALSE(world.castRay(start, {1.0, 0.0, 0.0}, 15.0));
  // Falls 0.1 m over 5 m: above the front wall at 4 m, on the roof at 5 m.
  const Eigen::Vector3d falling = Eigen::Vector3d(5.0, 0.0, -0.1).normalized();
  CHECK(*world.castRay(start, falling, 15.0) == Approx(std::hypot(5.0, 0.1)));
  // Falls below the roof before the wall: hits the wall.
  const Eigen::Vector3d steep = Eigen::Vector3d(4.0, 0.0, -0.2).normalized();
  CHECK(*world.castRay(start, steep, 15.0) == Approx(std::hypot(4.0, 0.2)));
  const Eigen::Vector3d ground = Eigen::Vector3d(-2.0, 0.0, -0.5).normalized();
  CHECK(*world.castRay(start, ground, 15.0) == Approx(std::hypot(2.0, 0.5)));
}

TEST_CASE("beams meet sloping ground where a fine march along the beam meets it") {
  WorldDescription description;
  description.terrain.waves = {{0.4, {0.5, 0.2}, 0.3}, {0.2, {-0.3, 0.7}, 1.0}};
  description.terrain.bumps = {{{6.0, 2.0}, 0.8, 2.0}, {{-5.0, -4.0}, -0.5, 1.5}};
  const World world(description);
  Random random(2);
  int hits = 0, missed = 0;
  for (int trial = 0; trial < testing::effort(500); ++trial) {
    const Eigen::Vector2d p(uniform(random, -10, 10), uniform(random, -10, 10));
    const Eigen::Vector3d start(p.x(), p.y(), world.height(p) + 0.5);
    const double yaw = uniform(random, -4, 4), pitch = uniform(random, -0.15, 0.1);
    const Eigen::Vector3d direction(std::cos(yaw) * std::cos(pitch),
                                    std::sin(yaw) * std::cos(pitch), std::sin(pitch));
    double wanted = 0.0;
    bool hit = false;
    for (; wanted < 15.0 && !hit; wanted += 0.002) {
      const Eigen::Vector3d at = start + wanted * direction;
      hit = at.z() <= world.height(at.head<2>());
    }
    const auto found = world.castRay(start, direction, 15.0);
    if (!hit || wanted > 14.9) continue;
    if (!found && ++missed <= 3) continue;  // grazing, within millimetres
    // Heights differ by millimetres: compare heights, not the distances of grazing beams.
    REQUIRE(found);
    const Eigen::Vector3d at = start + *found * direction;
    CHECK(std::abs(at.z() - world.height(at.head<2>())) < 0.02);
    CHECK(*found > wanted - 1.5);
    CHECK(*found < wanted + 1.5);
    ++hits;
  }
  CHECK(hits > testing::effort(200));
}

TEST_CASE("the terrain's gradient is the slope of its height and never above the bound") {
  Terrain terrain;
  terrain.waves = {{0.4, {0.5, 0.2}, 0.3}};
  terrain.bumps = {{{6.0, 2.0}, 0.8, 2.0}};
  Random random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Vector2d p(uniform(random, -10, 10), uniform(random, -10, 10));
    const double h = 1e-5;
    const Eigen::Vector2d numeric(
        (terrain.height(p + Eigen::Vector2d(h, 0)) - terrain.height(p - Eigen::Vector2d(h, 0))) /
            (2 * h),
        (terrain.height(p + Eigen::Vector2d(0, h)) - terrain.height(p - Eigen::Vector2d(0, h))) /
            (2 * h));
    CHECK((terrain.gradient(p) - numeric).norm() < 1e-6);
    CHECK(terrain.gradient(p).norm() <= terrain.steepestSlope() + 1e-12);
  }
}

TEST_CASE("footprint and obstacle touch exactly when some point belongs to both") {
  Random random(4);
  const std::vector<Obstacle> obstacles = randomObstacles(random, 300);
  const World world(flatWorld(obstacles));
  const Rectangle footprint{1.30, 0.68};
  int touches = 0, near = 0;
  for (int trial = 0; trial < testing::effort(1500); ++trial) {
    const Pose2 pose{uniform(random, -20, 20), uniform(random, -20, 20), uniform(random, -4, 4)};
    bool wanted = false;
    double margin = std::numeric_limits<double>::infinity();
    for (const Obstacle& obstacle : obstacles) {
      const Extent extent = extentOf(obstacle);
      if ((extent.low - pose.position()).maxCoeff() > 1.0) continue;
      if ((pose.position() - extent.high).maxCoeff() > 1.0) continue;
      // Corners of one in the other, and a dense set of points on the footprint's border.
      const auto outline = outlineOf(obstacle);
      for (const Eigen::Vector2d& corner : outline) {
        const Eigen::Vector2d p = inverse(pose) * corner;
        wanted |= std::abs(p.x()) <= footprint.length / 2 && std::abs(p.y()) <= footprint.width / 2;
      }
      for (int i = 0; i <= 26; ++i) {
        for (int j = 0; j <= 14; ++j) {
          if (i % 26 != 0 && j % 14 != 0) continue;
          const Eigen::Vector2d p = pose * Eigen::Vector2d((i / 26.0 - 0.5) * footprint.length,
                                                           (j / 14.0 - 0.5) * footprint.width);
          wanted |= inside(outline, p);
        }
      }
      margin = std::min(margin, std::abs(penetrationOf(obstacle, footprint, pose)));
    }
    const auto found = world.collision(footprint, pose);
    if (margin < 0.05) {
      ++near;  // closer than the points' spacing: undecidable
      continue;
    }
    CHECK(found.has_value() == wanted);
    touches += found.has_value() ? 1 : 0;
    if (found)
      CHECK(found->penetration == penetrationOf(obstacles[found->obstacle], footprint, pose));
  }
  CHECK(touches > testing::effort(100));
  CHECK(near < 700);
}

TEST_CASE("penetration is the shortest way out") {
  const Obstacle box = boxObstacle({2.0, 0.0, 0.0}, 1.0, 1.0, 1.0);
  const Rectangle footprint{1.0, 1.0};
  CHECK(penetrationOf(box, footprint, {1.2, 0.0, 0.0}) == Approx(0.2));
  CHECK(penetrationOf(box, footprint, {1.2, 0.9, 0.0}) == Approx(0.1));
  CHECK(penetrationOf(box, footprint, {0.8, 0.0, 0.0}) < 0.0);
  const Obstacle disc = discObstacle({2.0, 0.0}, 0.5, 1.0);
  CHECK(penetrationOf(disc, footprint, {1.2, 0.0, 0.0}) == Approx(0.2));
  CHECK(penetrationOf(disc, footprint, {1.2, 0.8, 0.0}) == Approx(0.5 - std::hypot(0.3, 0.3)));
}

TEST_CASE("later regions lie on top of earlier ones and of the base surface") {
  WorldDescription description;
  description.base_surface = "tarmac";
  description.regions = {stripRegion("cinder", {-10.0, 0.0}, {10.0, 0.0}, 4.0),
                         {"grass", {{0.0, -5.0}, {5.0, -5.0}, {5.0, 5.0}, {2.5, 1.0}, {0.0, 5.0}}}};
  const World world(description);
  CHECK(world.surface({-5.0, 1.9}).name == "cinder");
  CHECK(world.surface({-5.0, 2.1}).name == "tarmac");
  CHECK(world.surface({1.0, 0.0}).name == "grass");
  CHECK(world.surface({2.5, 1.5}).name == "cinder");  // in the notch of the polygon
  CHECK(world.surface({2.5, 3.0}).name == "tarmac");
  CHECK(world.surface({12.0, 0.0}).name == "tarmac");
}

TEST_CASE("a description that makes no world is refused with place and reason") {
  WorldDescription unknown;
  unknown.base_surface = "jelly";
  CHECK(worldFault(unknown)->find("'jelly'") != std::string::npos);
  WorldDescription clockwise;
  clockwise.obstacles = {boxObstacle({}, 1.0, 1.0, 1.0), boxObstacle({}, 1.0, 1.0, 1.0)};
  std::swap(clockwise.obstacles[1].corners[0], clockwise.obstacles[1].corners[2]);
  CHECK(worldFault(clockwise)->find("obstacle 2") != std::string::npos);
  WorldDescription star;
  Obstacle pentagram;
  for (int i = 0; i < 5; ++i)
    pentagram.corners.emplace_back(std::cos(i * 0.8 * kPi), std::sin(i * 0.8 * kPi));
  star.obstacles = {pentagram};
  CHECK(worldFault(star)->find("crosses itself") != std::string::npos);
  CHECK_THROWS_WITH(World(star), Catch::Contains("obstacle 1"));
}

TEST_CASE("worlds of any size can be built and asked") {
  WorldDescription description;
  description.bounds = {{-90000.0, -90000.0}, {90000.0, 90000.0}};
  description.obstacles = {discObstacle({-90000.0, -90000.0}, 1.0, 1.0),
                           discObstacle({90000.0, 90000.0}, 1.0, 1.0)};
  description.terrain.waves = {{0.5, {1e-3, 0.0}, 0.0}};
  const World world(description);
  CHECK(world.collision({}, {90000.5, 90000.0, 0.0}));
  CHECK_FALSE(world.collision({}, {0.0, 0.0, 0.0}));
  const Eigen::Vector3d start(89990.0, 90000.0, world.height({90000.0, 90000.0}) + 0.5);
  CHECK(*world.castRay(start, {1.0, 0.0, 0.0}, 15.0) == Approx(9.0).margin(0.01));
}

TEST_CASE("a surface of a world's own replaces the built-in one of the same name") {
  WorldDescription description;
  SurfaceParameters wet = *builtInSurface("grass");
  wet.friction = 0.3;
  description.surfaces = {wet};
  CHECK(World(description).surface({0.0, 0.0}).friction == 0.3);
}

}  // namespace tread::sim
