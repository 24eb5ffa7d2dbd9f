// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/config/config_reader.hpp"
#include "modules/simulator/simulator_files.hpp"

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

TEST_CASE("a world file describes surfaces, strips, terrain and obstacles") {
  const WorldDescription world = parseWorld(
      "name: 'a \"quoted\" name'\n"
      "surfaces: [{name: wet grass, like: grass, friction: 0.31}]\n"
      "base_surface: wet grass\n"
      "regions: [{surface: cinder, strip: [0, 0, 4, 0], width: 2}]\n"
      "terrain: {waves: [{amplitude: 0.3, k: [0.1, 0.2]}], bumps: [{centre: [1, 2], height: -0.4, "
      "radius: 1.5}]}\n"
      "rough: [{corners: [[0, 0], [8, 0], [8, 4]], rms: 0.03, longest: 3, seed: 5}]\n"
      "obstacles: [{box: [1, 1, 0], length: 2, width: 0.4, height: 1.1}, "
      "{disc: [5, 5], radius: 0.4, name: bollard}]\n",
      "w.yaml");
  CHECK(world.name == "a \"quoted\" name");
  CHECK(world.surfaces[0].friction == 0.31);
  CHECK(world.surfaces[0].shear_displacement == builtInSurface("grass")->shear_displacement);
  CHECK(world.regions[0].corners == stripRegion("cinder", {0, 0}, {4, 0}, 2).corners);
  CHECK(world.terrain.waves[0].k == Eigen::Vector2d(0.1, 0.2));
  CHECK(world.terrain.bumps[0].height == -0.4);
  CHECK(world.rough[0].corners[2] == Eigen::Vector2d(8.0, 4.0));
  CHECK(world.rough[0].rms == 0.03);
  CHECK(world.rough[0].longest == 3.0);
  CHECK(world.rough[0].shortest == RoughRegion().shortest);
  CHECK(world.rough[0].seed == 5);
  CHECK(world.obstacles[0].corners == boxObstacle({1, 1, 0}, 2.0, 0.4, 1.1).corners);
  CHECK(world.obstacles[1].name == "bollard");
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
  CHECK_THAT(
      refusalOf("rough:\n  - {corners: [[0, 0], [8, 0], [8, 4]], shortest: 3, longest: 2}\n"),
      Contains("longest"));
  CHECK_THAT(refusalOf("rough:\n  - {corners: [[0, 0], [8, 0]]}\n"), Contains("three corners"));
  CHECK_THAT(refusalOf("terrain:\n  waves:\n    - {amplitude: 1}\n"), Contains("k"));
  CHECK_THROWS_AS(readWorld("/nowhere/world.yaml"), ConfigError);
}

}  // namespace tread::sim
