// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include "tests/mapping/small_world.hpp"

using namespace tread;
using namespace tread::mapping;

namespace {

/// Sweeps across y in [-4, 4] m, one every 10 cm of x from 1 to 3 m.
template <class Height>
RoughnessMap seen(Height&& height, double noise, double tilt = 0.0) {
  RoughnessMap map(0.1, 256);
  map.moveTo({-128, -128});
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (double x = 1.0; x < 3.0; x += 0.1) {
    std::vector<GroundPoint> points;
    const double pose_error = 0.01 * normal(random);  // shifts a complete sweep
    for (double y = -4.0; y < 4.0; y += 0.04)
      points.push_back(
          {{x, y, height(x, y) + tilt * y + pose_error + noise * normal(random)}, noise * noise});
    map.take(points);
  }
  return map;
}

double bumps(double x, double y) {
  return 0.014142 * std::sin(2.0 * M_PI / 0.7 * (0.4 * x + 0.9165 * y));
}

}  // namespace

TEST_CASE("bumps are measured in millimetres RMS") {
  const RoughnessMap map = seen(bumps, 0.002);
  CHECK(map.at({20, 0}) == Approx(10).margin(2));
  CHECK(map.at({20, 20}) == Approx(10).margin(2));
}

TEST_CASE("neither range noise nor a slope nor a wrong pose is roughness") {
  const RoughnessMap map = seen([](double, double) { return 0.0; }, 0.003, 0.2);
  CHECK(map.at({20, 0}) >= 1);
  CHECK(map.at({20, 0}) <= 2);
}

TEST_CASE("ground that nobody saw has no roughness") {
  const RoughnessMap map = seen(bumps, 0.002);
  CHECK(map.at({-40, 0}) == kFree);
  CHECK(map.at({20, 60}) == kFree);
}

TEST_CASE("changes that do not matter are not told") {
  RoughnessMap map(0.1, 256);
  map.moveTo({-128, -128});
  size_t told = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<GroundPoint> points;
    for (double y = -0.7; y < 0.7; y += 0.04) points.push_back({{2.0, y, bumps(0.01 * i, y)}, 0.0});
    told += map.take(points).size();
  }
  CHECK(told >= 1);
  CHECK(told < 25);
}

TEST_CASE("a downward range finder makes the roughness of smooth ground known, walls stay walls") {
  OccupancyMapConfig config = usualMap();
  config.roughness.range_noise = 0.01;
  Mapper mapper(config);
  mapper.range_finder.T_body_sensor = isometryFrom({0.25, 0.0, 0.9}, {0.0, 0.25, 0.0});
  SmallWorld world;
  world.boxes.push_back({{6.5, -6.0, -1.0}, {7.0, 6.0, 1.5}});
  mapper.drive(world, {0.0, -0.6}, {4.0, -0.6});
  int smooth = 0;
  for (double x = 3.8; x < 6.2; x += 0.4) {
    const Cell cost = mapper.at(x, -2.4);
    if (isFree(cost) && cost >= 1 && cost <= 3) ++smooth;
  }
  CHECK(smooth >= 5);
  CHECK(mapper.at(6.55, -2.4) == kObstacle);
}

TEST_CASE("where roughness is not looked at, free cells cost nothing") {
  Mapper mapper;
  mapper.range_finder.T_body_sensor = isometryFrom({0.25, 0.0, 0.9}, {0.0, 0.25, 0.0});
  SmallWorld world;
  world.ground = bumps;
  mapper.drive(world, {0.0, 0.0}, {2.0, 0.0});
  for (const Cell cell : mapper.map.grid().cells()) REQUIRE((cell == kFree || !isFree(cell)));
}
