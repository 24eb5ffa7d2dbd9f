// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/config/config_reader.hpp"
#include "modules/simulator/world_file.hpp"

namespace tread::sim {
namespace {

std::string refusalOf(const std::string& text) {
  try {
    parseWorld(text, "w.yaml");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("the shipped worlds can be read and built, and their slopes are gentle") {
  const World world(readWorld(TREAD_SOURCE_DIR "/config/worlds/demo.yaml"));
  CHECK(world.description().name == "demo");
  CHECK(world.description().obstacles.size() == 11);
  CHECK(world.surface({0.0, 0.0}).name == "cinder");
  CHECK(world.surface({10.0, 0.0}).name == "gravel");
  CHECK(world.surface({-15.0, 0.0}).name == "grass");
  CHECK(world.surface({18.0, 0.0}).name == "tarmac");
  CHECK(world.description().terrain.steepestSlope() < 0.09);
  const Rectangle footprint{1.30, 0.68};
  CHECK_FALSE(world.collision(footprint, {-16.0, 0.0, 0.0}));
  CHECK(world.collision(footprint, {-8.0, 3.0, 0.0})->obstacle == 0);
}

TEST_CASE("a world written to a file is read back to the same numbers") {
  WorldDescription world;
  world.name = "a \"quoted\" name";
  world.bounds = {{-1.0 / 3.0, -5.0}, {7.123456789012345, 5.0}};
  SurfaceParameters wet = *builtInSurface("grass");
  wet.name = "wet grass";
  wet.friction = 0.31;
  world.surfaces = {wet};
  world.base_surface = "wet grass";
  world.regions = {stripRegion("cinder", {0.1, 0.2}, {3.3, 4.4}, 1.7)};
  world.terrain.waves = {{0.3, {0.1, 0.2}, 0.7}};
  world.terrain.bumps = {{{1.0, 2.0}, -0.4, 1.5}};
  world.obstacles = {boxObstacle({1.0, 1.0, 0.3}, 2.0, 0.4, 1.1),
                     discObstacle({5.0, 5.0}, 0.4, 0.7)};
  world.obstacles[1].name = "bollard";
  const std::string text = formatWorld(world);
  const WorldDescription again = parseWorld(text, "again");
  CHECK(formatWorld(again) == text);
  CHECK(again.obstacles[0].corners == world.obstacles[0].corners);
  CHECK(again.obstacles[1].name == "bollard");
  CHECK(again.bounds.low == world.bounds.low);
  CHECK(again.surfaces[0].friction == 0.31);
  CHECK(again.name == world.name);
}

TEST_CASE("an empty file is the default world") {
  const WorldDescription world = parseWorld("", "empty");
  CHECK(world.base_surface == "grass");
  CHECK(world.obstacles.empty());
}

TEST_CASE("errors in a world file name file, line and what is wrong") {
  using Catch::Contains;
  CHECK_THAT(refusalOf("name: x\nobstacels: []\n"), Contains("w.yaml:2") && Contains("obstacels"));
  CHECK_THAT(refusalOf("obstacles:\n  - disc: [1, 2]\n    radius: -1\n"), Contains("w.yaml:3"));
  CHECK_THAT(refusalOf("obstacles:\n  - disc: [1, 2]\n"),
             Contains("w.yaml:2") && Contains("radius"));
  CHECK_THAT(refusalOf("obstacles:\n  - {height: 1}\n"), Contains("w.yaml:2"));
  CHECK_THAT(refusalOf("obstacles:\n  - {disc: [1, 2], box: [0, 0, 0]}\n"), Contains("one of"));
  CHECK_THAT(refusalOf("obstacles:\n  - height: 1\n    corners: [[0, 0], [0, 1], [1, 0]]\n"),
             Contains("w.yaml:3") && Contains("counter-clockwise"));
  CHECK_THAT(refusalOf("regions:\n  - surface: cinder\n"),
             Contains("w.yaml:2") && Contains("strip"));
  CHECK_THAT(refusalOf("regions:\n  - {surface: cinder, strip: [1, 1, 1, 1]}\n"),
             Contains("differ"));
  CHECK_THAT(refusalOf("base_surface: jelly\n"), Contains("w.yaml:1") && Contains("'jelly'"));
  CHECK_THAT(refusalOf("surfaces:\n  - {name: wet, like: jelly}\n"), Contains("like"));
  CHECK_THAT(refusalOf("terrain:\n  waves:\n    - {amplitude: 1}\n"), Contains("k"));
  CHECK_THROWS_AS(readWorld("/nowhere/world.yaml"), ConfigError);
}

}  // namespace tread::sim
