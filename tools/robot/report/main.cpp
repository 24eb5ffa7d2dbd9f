// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <iostream>

#include <CLI/CLI.hpp>

#include "common/config/command_line.hpp"
#include "common/config/config_folder.hpp"
#include "common/config/outputs.hpp"
#include "modules/learner/core/rules/make_rule.hpp"
#include "modules/simulator/simulator_files.hpp"
#include "tools/robot/report/drive_report.hpp"

namespace {

using namespace tread;
using namespace tread::report;

struct Arguments {
  std::vector<std::string> logs;
  std::string world;
  std::string truth;
  std::string picture;
  std::vector<std::string> rules{"off", "collective", "multi_model"};
};

int run(const Arguments& arguments) {
  const DriveRecord drive = readDrive(arguments.logs);
  SimulationTruth truth;
  if (!arguments.world.empty()) truth.world = sim::readWorld(arguments.world);
  if (!arguments.truth.empty()) truth.rows = sim::readTruthRecord(arguments.truth);
  RuleErrors by_rule;
  std::vector<learner::Rule> rules;
  for (const std::string& name : arguments.rules)
    if (name != "none") rules.push_back(name);
  if (!rules.empty()) by_rule = errorsByRule(arguments.logs, shippedConfig() + "/patterns", rules);
  std::cout << reportOf(drive, truth, by_rule);
  if (!arguments.picture.empty()) {
    drawDrive(arguments.picture, sceneOf(drive, truth, by_rule));
    std::cout << "picture: " << arguments.picture << std::endl;
  }
  return endedWell(drive, truth) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Reports a drive from its LCM log: result, prediction errors, latencies, picture. Exit "
      "status 1 "
      "if the robot did not reach the first or the last goal, if the log ends in a fault or "
      "E-stop, or if the robot touched something.",
      "tread-report"};
  Arguments arguments;
  app.add_option("logs", arguments.logs, "LCM log; several are parts of one recording, in order")
      ->required();
  app.add_option("--world", arguments.world, "world file of a simulation: ground and obstacles");
  app.add_option("--truth", arguments.truth, "record of tread-simulator (--set record=FILE)");
  std::vector<std::string> names = learner::ruleNames();
  names.push_back("none");
  app.add_option("--rules", arguments.rules,
                 "learning rules to compare on the drive's executions, or none")
      ->delimiter(',')
      ->check(CLI::IsMember(names));
  Outputs(app).file("--picture", arguments.picture, "PNG file for a picture of the drive");
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  return runProgram("tread-report", [&] { return run(arguments); });
}
