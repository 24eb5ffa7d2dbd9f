// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "tests/helpers.hpp"
#include "tests/mapping/small_world.hpp"

using namespace tread;
using namespace tread::mapping;

namespace {

Box wall(double x_low, double y_low, double x_high, double y_high, double z_low = -1.0,
         double z_high = 2.0) {
  return {{x_low, y_low, z_low}, {x_high, y_high, z_high}};
}

/// Number of cells of a kind in a rectangle of map.
int count(const Mapper& mapper, Cell kind, double x_low, double y_low, double x_high,
          double y_high) {
  int number = 0;
  for (double x = x_low + 0.05; x < x_high; x += 0.1)
    for (double y = y_low + 0.05; y < y_high; y += 0.1) number += mapper.at(x, y) == kind ? 1 : 0;
  return number;
}

constexpr double kDegree = kPi / 180.0;

}  // namespace

TEST_CASE("a wall is an obstacle, the space before it free, what is behind it unknown") {
  SmallWorld world;
  world.boxes = {wall(4.03, -3.0, 4.3, 3.0)};
  Mapper mapper;
  mapper.look(world, world.stand(0, 0, 0));
  REQUIRE(count(mapper, kObstacle, 4.0, -2.0, 4.1, 2.0) == 40);
  REQUIRE(count(mapper, kFree, 1.5, -1.0, 3.9, 1.0) == 24 * 20);
  REQUIRE(count(mapper, kUnknown, 4.5, -1.0, 8.0, 1.0) == 35 * 20);
}

TEST_CASE("unknown is not free: what no beam has passed stays unknown") {
  SmallWorld world;
  Mapper mapper;
  mapper.look(world, world.stand(0, 0, 0));
  REQUIRE(mapper.at(-3.0, 0.0) == kUnknown);   // behind the robot
  REQUIRE(mapper.at(10.5, 0.0) == kUnknown);   // beyond the clearing range
  REQUIRE(mapper.at(100.0, 0.0) == kUnknown);  // beyond the window
  REQUIRE(mapper.at(9.5, 0.0) == kFree);
}

TEST_CASE(
    "beams without return clear up to the clearing range, returns beyond the marking range mark "
    "nothing") {
  SmallWorld world;
  world.boxes = {wall(9.0, -1.0, 9.3, 1.0)};
  OccupancyMapConfig config = usualMap();
  config.marking_range = 6.0;
  config.clearing_range = 8.0;
  Mapper mapper(config);
  mapper.look(world, world.stand(0, 0, 0));
  REQUIRE(mapper.at(8.0, 0.0) == kFree);
  REQUIRE(mapper.at(8.6, 0.0) == kUnknown);
  REQUIRE(mapper.at(9.05, 0.0) == kUnknown);
}

TEST_CASE("where a map begins the robot can turn on the spot, unless an obstacle is seen there") {
  SmallWorld world;
  world.boxes = {wall(0.5, 0.85, 0.9, 1.5)};
  Mapper mapper;
  mapper.look(world, world.stand(0, 0, 0.0));
  REQUIRE(mapper.at(-0.9, 0.0) == kFree);  // behind, never seen
  REQUIRE(mapper.at(-0.5, 0.6) == kFree);  // at the rear, never seen
  REQUIRE(mapper.at(-1.2, 0.0) == kUnknown);
  REQUIRE(mapper.at(0.5, 0.86) == kObstacle);
}

TEST_CASE(
    "what the robot stands on is free, and so is what it stood on while nothing is seen there") {
  SmallWorld world;
  Mapper mapper;
  mapper.drive(world, {0, 0}, {6, 0});
  REQUIRE(count(mapper, kFree, -0.6, -0.3, 6.6, 0.3) == 72 * 6);
  // An obstacle that seems to reach under the robot, which stands there nevertheless.
  world.boxes = {wall(6.43, -2.0, 7.5, 2.0)};
  mapper.look(world, world.stand(5.0, 0, 0),
              2);  // the first hit in well-known free space is not enough
  REQUIRE(mapper.at(6.45, 0.0) == kObstacle);
  mapper.look(SmallWorld{}, world.stand(6.0, 0, 0));
  REQUIRE(mapper.at(6.45, 0.0) == kFree);
}

TEST_CASE("returns from the robot itself are left out") {
  SmallWorld world;
  Mapper mapper;
  Scan scan = mapper.range_finder.scan(world, 2'000'000, world.stand(0, 0, 0));
  for (size_t i = 0; i < 60; ++i) {
    scan.beams[i].end *= 0.3 / scan.beams[i].end.norm();
    scan.beams[i].hit = true;
  }
  mapper.map.insert(scan);
  mapper.look(world, world.stand(2.0, 0, 0));
  REQUIRE(count(mapper, kObstacle, -2.0, -2.0, 4.0, 2.0) == 0);
}

TEST_CASE("an overhang above the robot is driven under, one that is too low is not") {
  SmallWorld world;
  Mapper mapper;
  mapper.range_finder.T_body_sensor = isometryFrom({0.25, 0.0, 0.5}, {0.0, -10.0 * kDegree, 0.0});
  world.boxes = {wall(5.0, -2.0, 5.3, 2.0, 1.3, 2.0)};  // is hit at 5.0 tan 10 degrees + 0.5
  mapper.look(world, world.stand(0, 0, 0));
  RangeFinder level;
  Scan scan = level.scan(world, mapper.utime += 100'000, world.stand(0, 0, 0));
  mapper.map.insert(scan);
  REQUIRE(mapper.at(5.05, 0.0) == kFree);

  Mapper low;
  low.range_finder.T_body_sensor = isometryFrom({0.25, 0.0, 0.5}, {0.0, -6.0 * kDegree, 0.0});
  world.boxes = {wall(5.0, -2.0, 5.3, 2.0, 0.8, 2.0)};
  low.look(world, world.stand(0, 0, 0));
  low.map.insert(level.scan(world, low.utime += 100'000, world.stand(0, 0, 0)));
  REQUIRE(low.at(5.05, 0.0) == kObstacle);
}

TEST_CASE(
    "on an even slope the ground is free and a wall is an obstacle, uphill, downhill and across") {
  for (const double degrees : {-12.0, -4.0, 4.0, 12.0})
    for (const double yaw : {0.0, 1.2, kPi / 2, 4.0}) {
      SmallWorld world;
      const double slope = std::tan(degrees * kDegree);
      world.ground = [slope](double x, double) { return slope * x; };
      const Eigen::Vector2d ahead(std::cos(yaw), std::sin(yaw));
      const Eigen::Vector2d at = 5.0 * ahead;
      world.boxes = {wall(at.x() - 0.5, at.y() - 0.5, at.x() + 0.5, at.y() + 0.5,
                          slope * at.x() - 1.0, slope * at.x() + 1.0)};
      Mapper mapper;
      mapper.look(world, world.stand(0, 0, yaw));
      CAPTURE(degrees, yaw);
      REQUIRE(count(mapper, kObstacle, at.x() - 0.6, at.y() - 0.6, at.x() + 0.6, at.y() + 0.6) > 8);
      REQUIRE(count(mapper, kObstacle, -9.0, -9.0, 9.0, 9.0) ==
              count(mapper, kObstacle, at.x() - 0.7, at.y() - 0.7, at.x() + 0.7, at.y() + 0.7));
      const Eigen::Vector2d before = 3.0 * ahead;
      REQUIRE(mapper.at(before.x(), before.y()) == kFree);
    }
}

TEST_CASE("a robot that pitches on a bump does not see the ground as a wall") {
  SmallWorld world;
  Mapper mapper;
  mapper.drive(world, {0, 0}, {6, 0});
  for (const double degrees : {1.0, 3.0, 5.0, 5.0, 5.0, 4.0, 2.0}) {
    Eigen::Isometry3d T_map_body = world.stand(6.0, 0, 0);
    T_map_body.rotate(Eigen::AngleAxisd(degrees * kDegree, Eigen::Vector3d::UnitY()));
    mapper.look(world, T_map_body);
    CAPTURE(degrees);
    REQUIRE(count(mapper, kObstacle, 0.0, -9.0, 18.0, 9.0) == 0);
    REQUIRE(mapper.at(11.95, 0.0) == kFree);  // where the pitched beams reach the ground
    REQUIRE(mapper.at(12.15, 0.0) == kFree);
  }
}

TEST_CASE("hits on rising ground ahead do not stay as obstacles when the robot comes closer",
          "[statistics]") {
  SmallWorld world;
  world.ground = [](double x, double) {
    // Level, then with a smooth bend up to a slope of 8 degrees.
    const double slope = std::tan(8.0 * kDegree);
    const double s = std::max(0.0, x - 8.0);
    return s < 4.0 ? slope * s * s / 8.0 : slope * (s - 2.0);
  };
  Mapper mapper;
  mapper.drive(world, {0, 0}, {20, 0});
  REQUIRE(count(mapper, kObstacle, 0.0, -3.0, 26.0, 3.0) == 0);
  REQUIRE(count(mapper, kFree, 8.0, -1.0, 24.0, 1.0) == 160 * 20);
}

TEST_CASE("on rolling ground of a few degrees nothing near the robot is an obstacle") {
  SmallWorld world;
  world.ground = [](double x, double y) {
    return 0.11 * std::sin(0.449 * x + 0.7) + 0.02 * std::sin(0.4 * y);
  };
  Mapper mapper;
  for (double x = 0.0; x < testing::effort(40); x += 0.1) {
    mapper.look(world, world.stand(x, 0, 0));
    CAPTURE(x);
    REQUIRE(count(mapper, kObstacle, x - 10.0, -4.0, x + 4.0, 4.0) == 0);
    if (x > 3.0) REQUIRE(count(mapper, kFree, x + 1.0, -1.0, x + 4.0, 1.0) == 30 * 20);
  }
}

TEST_CASE("behind an edge there is no way down, neither seen at a slant nor from above") {
  for (const double look_down : {0.26, 0.8}) {
    SmallWorld world;
    world.ground = [](double x, double) { return x > 4.0 ? -0.6 : 0.0; };
    Mapper mapper;
    mapper.range_finder.T_body_sensor = isometryFrom({0.4, 0.0, 0.9}, {0.0, look_down, 0.0});
    mapper.range_finder.field_of_view = 1.2;
    mapper.range_finder.beams = 241;
    mapper.drive(world, {0.0, 0.0}, {3.2, 0.0});
    CAPTURE(look_down);
    for (double x = 1.0; x < 3.9; x += 0.1) CHECK(isFree(mapper.at(x, 0.05)));
    // Near the edge a row across the path is not free.
    int closed = 0;
    for (double x = 4.0; x < 4.6; x += 0.1) {
      bool free = false;
      for (double y = -0.3; y < 0.4; y += 0.1) free = free || isFree(mapper.at(x + 0.05, y + 0.05));
      closed += free ? 0 : 1;
    }
    CHECK(closed > 0);
  }
}

TEST_CASE("a slope down that the robot can drive is free once its ground is seen") {
  SmallWorld world;
  world.ground = [](double x, double) { return x > 4.0 ? -0.15 * (x - 4.0) : 0.0; };
  Mapper mapper;
  mapper.range_finder.T_body_sensor = isometryFrom({0.4, 0.0, 0.9}, {0.0, 0.35, 0.0});
  mapper.range_finder.field_of_view = 1.2;
  mapper.range_finder.beams = 241;
  mapper.drive(world, {0.0, 0.0}, {6.0, 0.0});
  for (double x = 4.05; x < 7.0; x += 0.1) {
    CAPTURE(x, int(mapper.at(x, 0.05)));
    CHECK(isFree(mapper.at(x, 0.05)));
  }
}

TEST_CASE("an obstacle stays one while the robot drives past on rolling ground and away",
          "[statistics]") {
  SmallWorld world;
  world.ground = [](double x, double) { return 0.11 * std::sin(0.449 * x + 0.7); };
  const double base = world.ground(8.2, 2.2);
  world.boxes = {wall(8.0, 2.0, 8.4, 2.4, base - 0.5, base + 0.9)};
  Mapper mapper;
  for (double x = 0.0; x < 16.0; x += 0.1) {
    mapper.look(world, world.stand(x, 0, 0));
    CAPTURE(x);
    if (x > 2.0) REQUIRE(count(mapper, kObstacle, 7.9, 1.9, 8.5, 2.5) >= 3);
  }
}

TEST_CASE("an obstacle that has gone is clear again after five scans, however long it stood") {
  SmallWorld with;
  with.boxes = {wall(4.0, -0.5, 4.5, 0.5)};
  const SmallWorld without;
  Mapper mapper;
  const Eigen::Isometry3d pose = without.stand(0, 0, 0);
  mapper.look(with, pose, 50);
  REQUIRE(mapper.at(4.05, 0.0) == kObstacle);
  mapper.look(without, pose, 5);
  REQUIRE(count(mapper, kFree, 3.5, -0.5, 5.0, 0.5) == 15 * 10);
}

TEST_CASE("a moving obstacle leaves no trail") {
  SmallWorld world;
  Mapper mapper;
  const Eigen::Isometry3d pose = world.stand(0, 0, 0);
  for (double y = -4.0; y < 4.0; y += 0.12) {
    world.boxes = {wall(3.0, y, 3.4, y + 0.4)};
    mapper.look(world, pose);
    if (y > 0.0) REQUIRE(count(mapper, kObstacle, 2.9, -4.0, 3.5, y - 0.8) == 0);
  }
}

TEST_CASE("a long wall seen at a grazing angle stays whole") {
  SmallWorld world;
  world.boxes = {wall(-2.0, 0.95, 14.0, 1.25)};
  Mapper mapper;
  for (double x = 0.0; x < 8.0; x += 0.1) {
    mapper.look(world, world.stand(x, 0, 0));
    CAPTURE(x);
    REQUIRE(count(mapper, kObstacle, x, 0.9, x + 4.0, 1.0) >= 39);
  }
  REQUIRE(count(mapper, kFree, 1.0, 0.3, 10.0, 0.8) == 90 * 5);
}

TEST_CASE("the beams of one scan are put where the robot was at each beam's time") {
  SmallWorld world;
  world.boxes = {wall(-6.0, 5.0, 6.0, 5.3), wall(-6.0, -5.3, 6.0, -5.0)};
  Mapper mapper;
  // Turning left by 90 degrees in 0.1 s during the sweep.
  Scan scan = mapper.range_finder.scan(world, 2'000'000, world.stand(0, 0, 0));
  scan.T_map_body_last = world.stand(0, 0, kPi / 2);
  for (size_t i = 0; i < scan.beams.size(); ++i) {
    const double yaw = kPi / 2 * scan.beams[i].share;
    scan.beams[i] = mapper.range_finder.cast(world, world.stand(0, 0, yaw), static_cast<int>(i));
  }
  mapper.map.insert(scan);
  REQUIRE(count(mapper, kObstacle, -8.0, -8.0, 8.0, 8.0) ==
          count(mapper, kObstacle, -8.0, 4.9, 8.0, 5.2) +
              count(mapper, kObstacle, -8.0, -5.2, 8.0, -4.9));
}

TEST_CASE("the window follows the robot and forgets what is far") {
  SmallWorld world;
  world.boxes = {wall(2.0, 2.0, 2.5, 2.5)};
  Mapper mapper;
  mapper.drive(world, {0, 0}, {30, 0});
  REQUIRE(mapper.at(2.05, 2.05) == kUnknown);
  REQUIRE(mapper.at(38.0, 0.0) == kFree);
  size_t leafs = 0;
  size_t outside = 0;
  for (auto leaf = mapper.map.voxels().tree().begin_leafs();
       leaf != mapper.map.voxels().tree().end_leafs(); ++leaf) {
    const auto cell = mapper.map.grid().indexOf({leaf.getX(), leaf.getY()});
    outside += mapper.map.grid().contains(cell) ? 0 : 1;
    ++leafs;
  }
  REQUIRE(outside == 0);
  REQUIRE(leafs > 10000);
}

TEST_CASE("scans that are not newer, of a robot on its side or too far away are refused") {
  SmallWorld world;
  Mapper mapper;
  mapper.look(world, world.stand(0, 0, 0));
  mapper.utime -= 100'000;
  REQUIRE(mapper.look(world, world.stand(0, 0, 0)) == OccupancyMap::Refusal::kNotNewer);
  Eigen::Isometry3d toppled = world.stand(0, 0, 0);
  toppled.rotate(Eigen::AngleAxisd(kPi / 2, Eigen::Vector3d::UnitX()));
  REQUIRE(mapper.look(world, toppled) == OccupancyMap::Refusal::kToppled);
  Eigen::Isometry3d far = world.stand(0, 0, 0);
  far.translation().x() = 3300.0;
  REQUIRE(mapper.look(world, far) == OccupancyMap::Refusal::kTooFar);
}

TEST_CASE("the same scans give the same map", "[statistics]") {
  const auto cells = [] {
    SmallWorld world;
    world.ground = [](double x, double y) { return 0.1 * std::sin(0.4 * x + 0.2 * y); };
    world.boxes = {wall(3.0, 1.0, 3.5, 2.0), wall(7.0, -3.0, 7.5, 0.0)};
    Mapper mapper;
    mapper.drive(world, {0, 0}, {8, 1});
    return mapper.map.grid().cells();
  };
  REQUIRE(cells() == cells());
}
