// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <string>

#include <catch2/catch.hpp>

#include "common/config/config_reader.hpp"
#include "common/vehicle/model_file.hpp"
#include "tools/robot/patterns/recipe.hpp"
#include "tools/robot/patterns/set_text.hpp"

using namespace tread;

namespace {

const std::string kModel =
    "name: m\nkind: power\nfull_speed: 1\ngauge: 0.5\nlag: 0.1\nyaw_gain: 0.9\n"
    "spread:\n  forward: 0.02\n";

const std::string kRecipe =
    "name: tiny\n"                                      // 1
    "period: 0.05\n"                                    // 2
    "classes:\n"                                        // 3
    "  - name: rest\n"                                  // 4
    "    steady: [0, 0]\n"                              // 5
    "patterns:\n"                                       // 6
    "  - name: turn_left\n"                             // 7
    "    mirror: turn_right\n"                          // 8
    "    entry: rest\n"                                 // 9
    "    exit: rest\n"                                  // 10
    "    commands: [[-0.5, 0.5, 0.2], [0, 0, 0.3]]\n";  // 11

std::string with(const std::string& piece, const std::string& replacement) {
  std::string text = kRecipe;
  const size_t at = text.find(piece);
  REQUIRE(at != std::string::npos);
  return text.replace(at, piece.size(), replacement);
}

PatternSet made(const std::string& recipe, const std::string& model = kModel) {
  return patterns::makeSet(ConfigReader::fromText(recipe, "r.yaml"),
                           parseModelDocument(model, "m.yaml").vehicle);
}

void expectError(const std::string& recipe, const std::string& place, const std::string& part) {
  std::string message = "no error";
  try {
    made(recipe);
  } catch (const ConfigError& error) {
    message = error.what();
  }
  INFO(message);
  CHECK(message.find("r.yaml:" + place + ": ") == 0);
  CHECK(message.find(part) != std::string::npos);
}

}  // namespace

TEST_CASE("A recipe makes a pattern and its mirror image, predicted by the model") {
  const PatternSet set = made(kRecipe);
  REQUIRE(set.patterns().size() == 2);
  const MotionPattern& left = set.patterns()[0];
  const MotionPattern& right = set.patterns()[1];
  CHECK(left.id == 1);
  CHECK(right.name == "turn_right");
  REQUIRE(left.commands.size() == 10);
  CHECK(left.commands[3][0] == -0.5);
  CHECK(right.commands[3][0] == 0.5);
  // A lag only delays: the total angle is rate times time, except for the rest after three lags.
  CHECK(left.end().yaw == Approx(0.9 * 2.0 * 0.2).epsilon(0.06));
  CHECK(right.end().yaw == -left.end().yaw);
  CHECK(set.version() == 1);
  CHECK(set.content().utime == 0);
}

TEST_CASE("Predictions are whole micrometres and microradians") {
  const PatternSet set = made(kRecipe);
  for (const Pose2& pose : set.patterns()[0].trajectory)
    CHECK(std::abs(pose.yaw * 1e6 - std::round(pose.yaw * 1e6)) < 1e-6);
}

TEST_CASE("A pattern that does not settle into its exit class is refused") {
  expectError(with("[0, 0, 0.3]", "[0, 0, 0.25]"), "11", "held for 0.25 s; at least 0.3 s");
  expectError(with(", [0, 0, 0.3]", ""), "11", "held for 0 s");
}

TEST_CASE("The delay of the model counts for settling, too") {
  CHECK_THROWS_AS(made(kRecipe, kModel + "delay: 0.1\n"), ConfigError);
}

TEST_CASE("Bad recipes are refused with file, line and what is allowed") {
  expectError(with("0.2]", "0.21]"), "11", "multiples of the period, 0.05 s");
  expectError(with("0.2]", "0]"), "11", "multiples of the period");
  expectError(with("[-0.5, 0.5,", "[-0.5, 1.5,"), "6", "command 1.5");
  expectError(with("entry: rest", "entry: rist"), "9", "rest");
  expectError(with("steady: [0, 0]", "steady: [0, 2]"), "5", "-1..1");
  expectError(with("mirror: turn_right", "mirror: turn_left"), "6", "used twice");
  expectError(with("period: 0.05", "period: 0.05\nfast: true"), "3", "fast");
}

TEST_CASE("The table shows each pattern on a line") {
  const std::string table = patterns::table(made(kRecipe));
  CHECK(table.find("tiny: version 1, 2 patterns, power, 50 ms a sample") == 0);
  CHECK(table.find("turn_left") != std::string::npos);
  CHECK(table.find("turn_right") != std::string::npos);
}

TEST_CASE("A recipe of a holonomic base gives twists, and its patterns hold the rims' speeds") {
  const VehicleModel model = readModelFile(TREAD_SOURCE_DIR "/tests/data/robots/omni3/model.yaml");
  const std::string recipe =
      "name: omni\nperiod: 0.05\nclasses:\n"
      "  - {name: rest, steady: [0, 0, 0]}\n"
      "  - {name: left, steady: [0, 0.6, 0]}\n"
      "patterns:\n"
      "  - {name: go_left, entry: rest, exit: left, commands: [[0, 0.6, 0, 1.0]]}\n"
      "  - {name: step_left, mirror: step_right, entry: rest, exit: rest,"
      " commands: [[0.2, 0.4, 0.3, 0.6], [0, 0, 0, 0.6]]}\n";
  const PatternSet set = patterns::makeSet(ConfigReader::fromText(recipe, "r.yaml"), model);
  CHECK(describe(set.content().channels) == "wheel1 [m/s], wheel2 [m/s], wheel3 [m/s]");
  const MotionPattern& go = *set.findByName("go_left");
  const Command speeds = model.wheels.speeds({0.0, 0.6, 0.0});
  for (size_t i = 0; i < 3; ++i) CHECK(go.commands[5][i] == Approx(speeds[i]).margin(1e-6));
  CHECK(go.end().y > 0.4);
  CHECK(std::abs(go.end().x) < 1e-6);
  const Pose2 left = set.findByName("step_left")->end();
  const Pose2 right = set.findByName("step_right")->end();
  CHECK(right.x == Approx(left.x).margin(2e-6));
  CHECK(right.y == Approx(-left.y).margin(2e-6));
  CHECK(right.yaw == Approx(-left.yaw).margin(2e-6));
  CHECK_THROWS_WITH(patterns::makeSet(ConfigReader::fromText(kRecipe, "r.yaml"), model),
                    Catch::Contains("r.yaml:5") && Catch::Contains("steady"));
  CHECK_THROWS_WITH(patterns::requireSameKind(made(kRecipe), model),
                    Catch::Contains("give a model of the same vehicle"));
  const recordings::SurfaceRecordings recorded = patterns::recordModel(
      set, readModelDocument(TREAD_SOURCE_DIR "/tests/data/robots/omni3/model.yaml"), "floor", {});
  CHECK(recorded.executions[0].size() == 30);
  CHECK(recorded.executions[0][0].back().y == Approx(go.end().y).epsilon(0.2));
}
