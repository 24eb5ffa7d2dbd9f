// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <string>

#include <catch2/catch.hpp>

#include "common/config/config_reader.hpp"
#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model_file.hpp"
#include "tests/tools/robot/patterns/patterns_program.hpp"
#include "tools/robot/patterns/recipe.hpp"
#include "tools/robot/patterns/recipe_text.hpp"
#include "tools/robot/patterns/set_text.hpp"

using namespace tread;
using namespace tread::patterns;

namespace {

/// A vehicle of each kind, with the limits of its robot.yaml.
struct Designed {
  std::string name;
  VehicleModel model;
  RecipeWish wish;
};

std::vector<Designed> robots() {
  const std::string data = TREAD_SOURCE_DIR "/tests/data/robots/";
  std::vector<Designed> all{
      {"tracks", readModelFile(kit::kConfigFolder + "models/teodor_tarmac.yaml"), {}},
      {"car", readModelFile(data + "car/model.yaml"), {}},
      {"omni", readModelFile(data + "omni3/model.yaml"), {}}};
  for (Designed& robot : all) robot.wish.name = robot.name;
  all[2].wish.max_command = 1.2;
  return all;
}

PatternSet setOf(const VehicleModel& model, const RecipeWish& wish) {
  return makeSet(ConfigReader::fromText(recipeText(designRecipe(model, wish), ""), "r.yaml"),
                 model);
}

std::string refusal(const VehicleModel& model, const RecipeWish& wish) {
  try {
    designRecipe(model, wish);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a designed recipe makes a set in which every class is reached, kept and left") {
  for (const Designed& robot : robots()) {
    INFO(robot.name);
    const PatternSet set = setOf(robot.model, robot.wish);
    CHECK(set.patterns().size() <= 40);
    CHECK(set.patterns().size() >= 39);
    for (const char* name : {"rest", "crawl", "slow", "full", "creep_back", "back"}) {
      INFO(name);
      CHECK_NOTHROW(set.classNamed(name));
      CHECK(connectedClasses(set, {"rest"}, false).count(name) == 1);
      CHECK(connectedClasses(set, {"rest"}, true).count(name) == 1);
    }
    const double full = set.classNamed("full").twist.v_x;
    CHECK(set.classNamed("crawl").twist.v_x == Approx(0.2 * full).epsilon(0.02));
    CHECK(set.classNamed("slow").twist.v_x == Approx(0.5 * full).epsilon(0.02));
  }
}

TEST_CASE("designed patterns come with their mirror images") {
  for (const Designed& robot : robots()) {
    INFO(robot.name);
    const PatternSet set = setOf(robot.model, robot.wish);
    int left = 0, right = 0;
    for (const MotionPattern& pattern : set.patterns()) {
      left += static_cast<int>(pattern.end().y > 0.02);
      right += static_cast<int>(pattern.end().y < -0.02);
    }
    CHECK(left == right);
    CHECK(left >= 4);
  }
}

TEST_CASE("each pattern adds coverage, and the same wish gives the same bytes") {
  for (const Designed& robot : robots()) {
    INFO(robot.name);
    const DesignedRecipe recipe = designRecipe(robot.model, robot.wish);
    for (const DesignedPattern& pattern : recipe.patterns)
      CHECK(pattern.after <= pattern.before + 1e-12);
    RecipeWish more = robot.wish;
    more.patterns = 80;
    const DesignedRecipe larger = designRecipe(robot.model, more);
    CHECK(larger.count() >= 79);
    CHECK(larger.patterns.back().after < recipe.patterns.back().after);
    CHECK(recipeText(designRecipe(robot.model, robot.wish), "") == recipeText(recipe, ""));
  }
}

TEST_CASE("a designed recipe keeps to the limits of the robot") {
  for (Designed robot : robots()) {
    INFO(robot.name);
    robot.wish.max_command *= 0.6;
    robot.wish.max_steering = 0.3;
    robot.wish.room = 2.0;
    const PatternSet set = setOf(robot.model, robot.wish);
    const CommandChannels channels = set.content().channels;
    for (const MotionPattern& pattern : set.patterns())
      for (const Command& command : pattern.commands)
        for (size_t i = 0; i < channels.size(); ++i) {
          const bool steers = channels[i].kind == CommandKind::kSteeringAngle;
          CHECK(std::abs(command[i]) <= (steers ? 0.3 : robot.wish.max_command) + 2e-3);
        }
    for (const double way : restToRestLengths(set)) CHECK(way < 2.3);
  }
}

TEST_CASE("a weak side and dead power are made up for, so that straight is straight") {
  VehicleModel model = readModelFile(kit::kConfigFolder + "models/teodor_tarmac.yaml");
  model.effects.track_asymmetry = 0.1;
  model.effects.motor_deadband = 0.1;
  RecipeWish wish;
  wish.name = "weak";
  const PatternSet set = setOf(model, wish);
  for (const char* name : {"crawl", "slow", "full"})
    CHECK(std::abs(set.classNamed(name).twist.omega) < 0.01);
  const Command crawl = set.classNamed("crawl").steady;
  CHECK(crawl[1] > crawl[0]);
  CHECK(crawl[0] > 0.2);
}

TEST_CASE("fewer patterns are for fewer speeds, and what cannot be is told in a line") {
  const VehicleModel model = robots()[0].model;
  RecipeWish wish;
  wish.name = "few";
  wish.patterns = 12;
  CHECK(designRecipe(model, wish).classes.size() == 3);  // rest, full, back
  wish.speeds = {0.2, 0.5, 1.0};
  CHECK_THAT(refusal(model, wish), Catch::Contains("12 patterns are too few"));
  wish.patterns = 40;
  wish.speeds = {0.5, 3.0};
  CHECK_THAT(refusal(model, wish), Catch::Contains("3.00 m/s exceeds the robot's top speed"));
  wish.speeds = {};
  wish.seconds = 0.3;
  CHECK_THAT(refusal(model, wish), Catch::Contains("too short"));
}

TEST_CASE("tread-patterns recipe writes what make takes, and tells what each pattern adds") {
  const kit::Folder folder;
  const std::string recipe = folder.path("recipe.yaml");
  const std::string model = kit::kConfigFolder + "models/teodor_tarmac.yaml";
  const kit::Run run = kit::run("recipe " + kit::kConfigFolder + "robots/teodor --model " + model +
                                " --patterns 30 --gap 1 -o " + recipe);
  CHECK(run.status == 0);
  CHECK_THAT(run.printed, Catch::Contains("start_full (needed)"));
  const kit::Run made =
      kit::run("make " + recipe + " --model " + model + " -o " + folder.path("set.yaml"));
  CHECK(made.status == 0);
  CHECK_THAT(made.printed, Catch::Contains("30 patterns"));
  const std::string car = TREAD_SOURCE_DIR "/tests/data/robots/car";
  const kit::Run wrong =
      kit::run("recipe " + car + " --model " + model + " -o " + folder.path("no.yaml"));
  CHECK(wrong.status == 2);
  CHECK_THAT(wrong.printed, Catch::Contains("give a model of the same vehicle"));
}
