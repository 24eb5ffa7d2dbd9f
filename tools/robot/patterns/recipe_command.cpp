// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// recipe: makes a recipe from the limits of a robot.
#include "tools/robot/patterns/recipe_command.hpp"

#include <iostream>
#include <memory>
#include <string>

#include "common/config/config_reader.hpp"
#include "common/config/outputs.hpp"
#include "common/report/text.hpp"
#include "common/store/store.hpp"
#include "common/vehicle/model_file.hpp"
#include "common/vehicle/robot_description.hpp"
#include "tools/robot/patterns/commands.hpp"
#include "tools/robot/patterns/recipe_text.hpp"

namespace tread::patterns {
namespace {

constexpr double kRoomInGap = 0.3;  // [m] default, in addition to the footprint

struct RecipeOptions {
  std::string robot;
  std::string model;
  std::string output;
  RecipeWish wish;
  double gap = 0.0;  ///< [m]; 0 = footprint plus kRoomInGap
};

void makeRecipe(const RecipeOptions& options) {
  ConfigReader beside = ConfigReader::fromText("{}", options.robot + "/patterns");
  const RobotDescription robot = readRobot(beside);
  const ModelDocument model = readModelDocument(options.model);
  if (model.vehicle.channels().size() != robot.drive.channels().size() ||
      kindsOf(model.vehicle.channels()) != kindsOf(robot.drive.channels()))
    throw std::runtime_error(options.model + ": takes " + describe(model.vehicle.channels()) +
                             ", the robot " + describe(robot.drive.channels()) +
                             "; give a model of the same vehicle");
  RecipeWish wish = options.wish;
  if (wish.name.empty()) wish.name = robot.name;
  wish.max_command = robot.drive.max_command;
  wish.max_steering = robot.drive.max_steering;
  wish.gap = options.gap > 0.0 ? options.gap : 2.0 * robot.footprint.half_width + kRoomInGap;
  const DesignedRecipe recipe = designRecipe(model.vehicle, wish);
  writeText(options.output, recipeText(recipe, "# Made by tread-patterns recipe for a gap of " +
                                                   fixed(wish.gap, 2) + " m.\n"));
  std::cout << gainsTable(recipe);
}

}  // namespace

CLI::App* addRecipe(CLI::App& app) {
  const auto options = std::make_shared<RecipeOptions>();
  RecipeWish& wish = options->wish;
  CLI::App* command = app.add_subcommand(
      "recipe", "design a recipe from a robot's limits that covers its possible motions best");
  command
      ->add_option("ROBOT", options->robot,
                   "folder of the robot, for instance config/robots/teodor")
      ->required();
  command->add_option("--model", options->model, "model file for the predictions")->required();
  Outputs(*command).file("-o,--output", options->output, "recipe to write")->required();
  command->add_option("--patterns", wish.patterns, "largest number of patterns, default 40")
      ->check(CLI::Range(8, 500));
  command
      ->add_option("--speeds", wish.speeds,
                   "forward speeds [m/s], at most four; default, depending on --patterns: up to "
                   ".2, .5 and 1 of "
                   "the full speed")
      ->delimiter(',')
      ->check(CLI::Range(0.02, 20.0));
  command
      ->add_option("--gap", options->gap,
                   "width of the narrowest gap to pass [m]; default: .3 more than the footprint")
      ->check(CLI::Range(0.1, 20.0));
  command
      ->add_option("--seconds", wish.seconds,
                   "longest pattern at full speed [s]; default: nine lags")
      ->check(CLI::Range(0.1, 10.0));
  command->add_option("--acceleration", wish.acceleration, "largest acceleration [m/s2], default 4")
      ->check(CLI::Range(0.1, 20.0));
  command->callback([options] { makeRecipe(*options); });
  return command;
}

}  // namespace tread::patterns
