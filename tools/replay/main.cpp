// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "common/config/command_line.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/vehicle/model_file.hpp"
#include "tools/replay/ins_picture.hpp"
#include "tools/replay/learner_report.hpp"
#include "tools/replay/live_run.hpp"
#include "tools/replay/mapping_picture.hpp"
#include "tools/replay/recipe.hpp"
#include "tools/replay/robot_commands.hpp"

using namespace tread;

namespace {

/// Where results go beside the terminal.
struct Output {
  std::string report;
  std::string picture;
};

void addOutput(CLI::App& command, Output& output) {
  command.add_option("--report", output.report, "also write the report into this file");
  command.add_option("--picture", output.picture, "also draw a picture (PNG)");
}

void say(const std::string& report, const Output& output) {
  std::fputs(report.c_str(), stdout);
  if (output.report.empty()) return;
  std::ofstream file(output.report);
  if (!(file << report) || !file.flush())
    throw std::runtime_error(output.report + ": cannot be written");
}

struct InsArguments {
  std::string log;
  std::string config;
  Output output;
};

void replayInsLog(const InsArguments& arguments) {
  ConfigReader reader = arguments.config.empty() ? ConfigReader::fromText("{}", "defaults")
                                                 : ConfigReader::fromFile(arguments.config);
  const InsReplay replay = replayInsFile(arguments.log, ins::readInsDriverConfig(reader));
  say(arguments.log + "\n" + reportOf(replay), arguments.output);
  if (!arguments.output.picture.empty())
    drawTrack(replay, arguments.log + " through ins_driver", arguments.output.picture);
}

void addIns(CLI::App& app, InsArguments& arguments) {
  CLI::App& command = *app.add_subcommand("ins", "an NMEA 0183 log through ins_driver");
  command.add_option("log", arguments.log, "what a device said, as bytes")->required();
  command.add_option("--config", arguments.config, "configuration of ins_driver");
  addOutput(command, arguments.output);
  command.callback([&arguments] { replayInsLog(arguments); });
}

struct MappingArguments {
  std::string log;
  Output output;
};

void replayMappingLog(const MappingArguments& arguments) {
  const MappingReplay replay = replayMapping(readMappingRecording(arguments.log));
  say(reportOf(replay), arguments.output);
  if (!arguments.output.picture.empty()) drawMap(replay, arguments.output.picture);
}

void addMapping(CLI::App& app, MappingArguments& arguments) {
  CLI::App& command = *app.add_subcommand("mapping", "range scans with poses through mapping");
  command.add_option("log", arguments.log, "CARMEN log (*.log.gz, *.clf) or LCM log of an MBot")
      ->required();
  addOutput(command, arguments.output);
  command.callback([&arguments] { replayMappingLog(arguments); });
}

struct PlannerArguments {
  std::string log;
  std::string config;
  Output output;
  bool different = false;
};

void addPlanner(CLI::App& app, PlannerArguments& arguments) {
  CLI::App& command = *app.add_subcommand(
      "planner",
      "the log of a running robot through the planner; code 1 if different or not compared");
  command.add_option("log", arguments.log, "LCM log")->required();
  command.add_option("--config", arguments.config, "configuration of the planner; else the log's");
  command.add_option("--report", arguments.output.report, "also write the report into this file");
  command.callback([&arguments] {
    const replay::Verdict verdict = replay::replayRobotPlanner(arguments.log, arguments.config);
    say(verdict.report, arguments.output);
    arguments.different = !verdict.equal;
  });
}

struct LearnerArguments {
  std::string log;
  std::string config;
  std::string model;
  std::string patterns;
  std::string rule = "bank";
  double memory = 0.5;
  double max_gap = 0.3;
  double max_speed = 0.0;
  double entry_speed = 0.4;
  double entry_yaw_rate = 0.5;
  bool any_entry = false;
  std::string write_patterns;
  std::string write_config;
  std::string live;
  Output output;
  bool different = false;
};

learner::LearnerNodeConfig configOf(const LearnerArguments& arguments, const PatternSet& set) {
  learner::LearnerNodeConfig config(set);
  config.rule.memory = arguments.memory;
  config.limits.max_gap_us = std::llround(arguments.max_gap * 1e6);
  config.limits.max_speed = arguments.max_speed;
  config.limits.entry_speed = arguments.entry_speed;
  config.limits.entry_yaw_rate = arguments.entry_yaw_rate;
  // A model that is wrong about a steady turn is wrong about the twist in which it is entered, too.
  if (arguments.any_entry || !arguments.model.empty())
    config.limits.entry_speed = config.limits.entry_yaw_rate =
        std::numeric_limits<double>::infinity();
  return config;
}

void writeText(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  if (!(file << text) || !file.flush()) throw std::runtime_error(path + ": cannot be written");
}

/// What tread-learner needs to do the same with the same log.
void writeForProcess(const LearnerArguments& arguments, const PatternSet& set) {
  if (arguments.write_patterns.empty()) {
    if (arguments.write_config.empty()) return;
    throw std::runtime_error("--write-config needs --write-patterns, the file that it names");
  }
  writeText(arguments.write_patterns, formatPatterns(set));
  if (arguments.write_config.empty()) return;
  writeText(arguments.write_config,
            replay::processConfig(configOf(arguments, set), arguments.rule,
                                  std::filesystem::absolute(arguments.write_patterns).string()));
}

void compareLearner(LearnerArguments& arguments) {
  const replay::Verdict verdict = replay::replayRobotLearner(arguments.log, arguments.config);
  say(verdict.report, arguments.output);
  arguments.different = !verdict.equal;
}

void replayLearner(LearnerArguments& arguments) {
  const replay::DriveLog log = replay::readDriveLog(arguments.log);
  const PatternSet set = arguments.model.empty()
                             ? readPatternFile(arguments.patterns)
                             : replay::predictedSet(log, readModelFile(arguments.model));
  writeForProcess(arguments, set);
  learner::LearnerNodeConfig config = configOf(arguments, set);
  std::vector<replay::LearnerRun> runs;
  config.rule.rule = learner::Rule::kOff;
  runs.push_back(replay::runLearner(log, config, replay::Commitment::kAhead, "off"));
  config.rule.rule = *learner::ruleNamed(arguments.rule);
  if (config.rule.rule != learner::Rule::kOff) {
    runs.push_back(replay::runLearner(log, config, replay::Commitment::kAhead, arguments.rule));
    runs.push_back(
        replay::runLearner(log, config, replay::Commitment::kPrompt, arguments.rule + ", prompt"));
  }
  std::string notes =
      "Each execution is scored with the newest set when it began, as a planner knows it;\n"
      "'prompt': with the newest when it ended, when all before it were learned.\n";
  if (std::isinf(config.limits.entry_speed)) notes += "The gate on the entry twist was off.\n";
  std::string report = notes + "\n" + replay::reportOf(log, set, runs);
  if (!arguments.live.empty()) {
    const replay::LiveComparison live = replay::compareLive(
        replay::readRobotLog(arguments.live), log,
        replay::runLearner(log, config, replay::Commitment::kRecorded, arguments.rule));
    report += replay::reportOf(live);
    arguments.different = !live.sameReports();
  }
  say(report, arguments.output);
  if (!arguments.output.picture.empty())
    replay::drawReport(log, set, runs, arguments.output.picture);
}

void addLearner(CLI::App& app, LearnerArguments& arguments) {
  CLI::App& command = *app.add_subcommand("learner",
                                          "a log of executions through the learner; without "
                                          "--model and --patterns the log of a running "
                                          "robot, whose sets are compared: code 1 if different");
  command.add_option("log", arguments.log, "LCM log with INS, MOTOR and EXECUTION")->required();
  command.add_option("--config", arguments.config,
                     "configuration of the learner for a robot's log; else the log's");
  auto* source = command.add_option_group("prediction", "where the first predictions come from");
  source->add_option("--model", arguments.model,
                     "vehicle model file: predicts a pattern for each pattern id of the log");
  source->add_option("--patterns", arguments.patterns, "pattern file");
  source->require_option(0, 1);
  command.add_option("--rule", arguments.rule, "beside 'off'")
      ->check(CLI::IsMember(learner::ruleNames()))
      ->capture_default_str();
  command.add_option("--memory", arguments.memory, "weight of the old prediction")
      ->check(CLI::Range(0.0, 0.999))
      ->capture_default_str();
  command.add_option("--max-gap", arguments.max_gap, "longest INS gap of a fair measurement [s]")
      ->check(CLI::Range(0.01, 5.0))
      ->capture_default_str();
  command.add_option("--max-speed", arguments.max_speed, "of the vehicle [m/s]; 0 = of the set")
      ->check(CLI::Range(0.0, 20.0))
      ->capture_default_str();
  command.add_option("--entry-speed", arguments.entry_speed, "allowed off the entry class [m/s]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command.add_option("--entry-yaw-rate", arguments.entry_yaw_rate, "the same for yaw [rad/s]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command.add_flag("--any-entry", arguments.any_entry,
                   "no gate on the entry twist (always so with --model)");
  command.add_option("--write-patterns", arguments.write_patterns,
                     "write the set that learning begins with into a pattern file");
  command.add_option("--write-config", arguments.write_config,
                     "write a configuration with it and these gates for tread-learner");
  command.add_option(
      "--live", arguments.live,
      "lcm-logger's log of a run in which lcm-logplayer played LOG to tread-learner: "
      "compare what it heard and reported; code 1 if different");
  addOutput(command, arguments.output);
  command.callback([&arguments] {
    if (arguments.model.empty() && arguments.patterns.empty()) return compareLearner(arguments);
    replayLearner(arguments);
  });
}

struct RecipeArguments {
  std::string process;
  std::string log;
};

void addRecipe(CLI::App& app, RecipeArguments& arguments) {
  app.add_option("--recipe", arguments.process,
                 "print the lcm-logplayer command that plays LOG to this running process")
      ->check(CLI::IsMember(replay::playableProcesses()));
  app.add_option("LOG", arguments.log, "of --recipe");
  app.callback([&app, &arguments] {
    if (!app.get_subcommands().empty()) return;
    if (arguments.process.empty() || arguments.log.empty())
      throw CLI::ParseError("a command is needed, or --recipe PROCESS LOG", 2);
    std::fputs(replay::recipeFor(arguments.process, arguments.log).c_str(), stdout);
  });
}

int parseAndRun(int argc, char** argv) {
  LearnerArguments learner_arguments;
  PlannerArguments planner_arguments;
  InsArguments ins_arguments;
  MappingArguments mapping_arguments;
  RecipeArguments recipe_arguments;
  CLI::App app{"Recorded logs through the real nodes, on the virtual bus"};
  app.require_subcommand(0, 1);
  addRecipe(app, recipe_arguments);
  addLearner(app, learner_arguments);
  addPlanner(app, planner_arguments);
  addIns(app, ins_arguments);
  addMapping(app, mapping_arguments);
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  return learner_arguments.different || planner_arguments.different ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return parseAndRun(argc, argv);
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "tread-replay: %s\n", problem.what());
    return 1;
  }
}
