// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <iostream>

#include <CLI/CLI.hpp>

#include "common/bus/key_option.hpp"
#include "common/config/command_line.hpp"
#include "common/config/problem_words.hpp"
#include "modules/simulator/simulator_files.hpp"
#include "tools/robot/operator/calls.hpp"
#include "tools/robot/operator/command.hpp"

namespace {

using namespace tread;
using namespace tread::operators;

/// Surface names from a world file; throws ConfigError.
SurfaceNames namesFrom(const std::string& path) {
  if (path.empty()) return {};
  const auto world = std::make_shared<const sim::World>(sim::readWorld(path));
  return [world](const Eigen::Vector2d& p_map) { return world->surface(p_map).name; };
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Sends the robot to a goal and prints its progress until it has arrived. Ctrl-C cancels the "
      "goal: the robot stops.",
      "tread-goal"};
  CommandOptions options;
  options.holds = true;
  GoalRequest request;
  std::string world;
  std::string operator_name = operatorName();
  bool quiet = false;
  request.yaw_tolerance = 180.0;
  double yaw_degrees = 0.0;
  app.add_option("x", request.T_map_goal.x, "in map [m]")->required();
  app.add_option("y", request.T_map_goal.y, "in map [m]")->required();
  app.add_option("yaw", yaw_degrees, "heading at the goal [deg]; ignored without --yaw-tolerance");
  app.add_option("--tolerance", request.position_tolerance, "[m]")->check(CLI::Range(0.05, 100.0));
  app.add_option("--yaw-tolerance", request.yaw_tolerance, "[deg]; 180 = any heading")
      ->check(CLI::Range(1.0, 180.0));
  app.add_option("--patience", request.patience, "give up after this time without a path [s]")
      ->check(CLI::Range(0.0, 3600.0));
  app.add_option("--timeout", options.timeout, "cancel the goal after this time [s]; 0 = never")
      ->check(CLI::Range(0.0, 86400.0));
  app.add_option("--world", world, "world file of a simulation: names the ground in the progress");
  app.add_flag("--quiet", quiet, "no progress");
  app.add_option("--operator", operator_name, kOperatorHelp)->capture_default_str();
  app.add_option("--lcm-url", options.lcm_url, kUrlHelp);
  addKeyOption(app, options.key);
  if (const auto code = tread::parseCommandLine(app, argc, argv)) return *code;
  request.T_map_goal.yaw = yaw_degrees * kPi / 180.0;
  request.yaw_tolerance *= kPi / 180.0;
  options.progress = quiet ? 0.0 : 1.0;
  SurfaceNames names;
  try {
    names = namesFrom(world);
  } catch (const std::exception& error) {
    std::cerr << "tread-goal: " << wordsOf(error) << std::endl;
    return 1;
  }
  return runCall("tread-goal", options, [&](Bus& bus) {
    return std::make_unique<GoalCall>(bus, request, operator_name, bus.now(), names);
  });
}
