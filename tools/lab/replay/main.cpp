// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cstdio>
#include <filesystem>
#include <limits>

#include <CLI/CLI.hpp>

#include "common/config/command_line.hpp"
#include "common/config/config_folder.hpp"
#include "common/config/config_reader.hpp"
#include "common/config/outputs.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/store/store.hpp"
#include "common/vehicle/model_file.hpp"
#include "modules/learner/core/rules/make_rule.hpp"
#include "tools/lab/replay/corpus.hpp"
#include "tools/lab/replay/learner_replay.hpp"
#include "tools/lab/replay/mapping_recording.hpp"
#include "tools/lab/replay/matching_replay.hpp"
#include "tools/lab/replay/pass_overlap.hpp"
#include "tools/lab/replay/pose_comparison.hpp"
#include "tools/lab/replay/robot_learner.hpp"
#include "tools/lab/replay/robot_planner.hpp"
#include "tools/lab/replay/robot_replay.hpp"
#include "tools/robot/report/logged_learner.hpp"

using namespace tread;

namespace {

/// Output files, in addition to the terminal.
struct Output {
  std::string report;
  std::string picture;
};

Outputs addReport(CLI::App& command, Output& output) {
  Outputs outputs(command);
  outputs.file("--report", output.report, "also write the report into this file");
  return outputs;
}

Outputs addOutput(CLI::App& command, Output& output) {
  Outputs outputs = addReport(command, output);
  outputs.file("--picture", output.picture, "also draw a picture (PNG)");
  return outputs;
}

void say(const std::string& report, const Output& output) {
  std::fputs(report.c_str(), stdout);
  if (!output.report.empty()) writeText(output.report, report);
}

/// Common options of all commands, and whether a comparison found a difference.
struct Arguments {
  std::string log;
  std::string config;
  Output output;
  bool different = false;
};

void replayInsLog(const Arguments& arguments) {
  ins::InsDriverConfig config;
  if (!arguments.config.empty()) {
    ConfigReader reader = ConfigReader::fromFile(arguments.config);
    config = ins::readInsDriverConfig(reader);
  }
  const InsReplay replay = replayInsFile(arguments.log, config);
  say(arguments.log + "\n" + reportOf(replay), arguments.output);
  if (!arguments.output.picture.empty())
    drawTrack(replay, arguments.log + " through ins_driver", arguments.output.picture);
}

void addIns(CLI::App& app, Arguments& arguments) {
  CLI::App& command = *app.add_subcommand(
      "ins", "recorded bytes of an INS, or a network capture, through ins_driver");
  command.add_option("log", arguments.log, "bytes of the device, or a capture (pcap, pcapng)")
      ->required();
  command.add_option(
      "--config", arguments.config,
      "configuration of ins_driver, whose `source` names the instrument; default: nmea");
  addOutput(command, arguments.output);
  command.callback([&arguments] { replayInsLog(arguments); });
}

void replayMappingLog(const Arguments& arguments) {
  const MappingRecording recording = readMappingRecording(arguments.log);
  const MappingReplay replay = replayMapping(recording);
  say(reportOf(replay) + reportOf(overlapOf(recording)), arguments.output);
  if (!arguments.output.picture.empty()) drawMap(replay, arguments.output.picture);
}

void addMapping(CLI::App& app, Arguments& arguments) {
  CLI::App& command =
      *app.add_subcommand("mapping", "recorded range scans with poses through mapping");
  command.add_option("log", arguments.log, "CARMEN log (*.log.gz, *.clf) or LCM log of an MBot")
      ->required();
  addOutput(command, arguments.output);
  command.callback([&arguments] { replayMappingLog(arguments); });
}

void replayMatchingLog(const Arguments& arguments) {
  ConfigReader reader = arguments.config.empty() ? ConfigReader::fromText("{}", "defaults")
                                                 : ConfigReader::fromFile(arguments.config);
  const MatchingReplay replay = replayMatching(readMappingRecording(arguments.log),
                                               scan_matching::readScanMatchingConfig(reader));
  say(reportOf(replay), arguments.output);
  if (!arguments.output.picture.empty()) drawTracks(replay, arguments.output.picture);
}

void addMatching(CLI::App& app, Arguments& arguments) {
  CLI::App& command = *app.add_subcommand(
      "matching", "the scans of such a recording through scan matching, compared with its poses");
  command.add_option("log", arguments.log, "as for mapping")->required();
  command.add_option("--config", arguments.config, "configuration of scan_matching");
  addOutput(command, arguments.output);
  command.callback([&arguments] { replayMatchingLog(arguments); });
}

void comparePlanner(Arguments& arguments) {
  const RobotLog log = readRobotLog({arguments.log});
  const auto config = [&] {
    if (arguments.config.empty()) return replay::plannerConfigOf(log);
    ConfigReader reader = ConfigReader::fromFile(arguments.config);
    return planner::readPlannerConfig(reader);
  };
  const replay::PlannerCheck check = replay::checkPlanner(log, config());
  say(reportOf(check), arguments.output);
  arguments.different = !check.equal();
}

void addPlanner(CLI::App& app, Arguments& arguments) {
  CLI::App& command = *app.add_subcommand("planner",
                                          "a robot's log through the planner, compared with its "
                                          "PLANs; code 1 if different or not compared");
  command.add_option("log", arguments.log, "LCM log")->required();
  command.add_option("--config", arguments.config,
                     "configuration of the planner; default: that of the log");
  addReport(command, arguments.output);
  command.callback([&arguments] { comparePlanner(arguments); });
}

struct LearnerArguments : Arguments {
  std::string model;
  std::string patterns;
  std::vector<std::string> rules{"multi_model"};
  std::string write_patterns;
  std::string poses = kIns.name;
};

/// For a robot's log: compares with its own sets and reports.
void compareLearner(LearnerArguments& arguments) {
  const RobotLog log = readRobotLog({arguments.log});
  const auto config = [&] {
    if (arguments.config.empty())
      return report::learnerConfigOf(log, shippedConfig() + "/patterns");
    ConfigReader reader = ConfigReader::fromFile(arguments.config);
    return learner::readLearnerConfig(reader);
  };
  const replay::LearnerCheck check = replay::checkLearner(log, config());
  say(reportOf(check), arguments.output);
  arguments.different = !check.equal();
}

/// For a robot's log: the learner's result with poses from another channel.
void compareLearnedPoses(const LearnerArguments& arguments) {
  std::string problem;
  const std::vector<LogEvent> events = readEvents({arguments.log}, problem);
  const auto config = [&] {
    if (arguments.config.empty())
      return report::learnerConfigOf(readRobotLog({arguments.log}), shippedConfig() + "/patterns");
    ConfigReader reader = ConfigReader::fromFile(arguments.config);
    return learner::readLearnerConfig(reader);
  };
  const std::string name = std::filesystem::path(arguments.log).stem().string();
  const std::string damage = problem.empty() ? "" : "  " + problem + "\n";
  say(name + ": " + reportOf(replay::comparePoses(name, events, arguments.poses, config())) +
          damage,
      arguments.output);
}

/// For a log without a learner: how well the rules predict its executions.
void replayLearner(LearnerArguments& arguments) {
  const tread::DriveLog log = replay::readLearnerLog(arguments.log);
  const PatternSet set = arguments.model.empty()
                             ? readPatternFile(arguments.patterns)
                             : replay::predictedSet(log, readModelFile(arguments.model));
  if (!arguments.write_patterns.empty()) writeText(arguments.write_patterns, formatPatterns(set));
  learner::LearnerNodeConfig config(set);
  std::string notes =
      "Each execution is scored with the newest set at its beginning, as a planner has it;\n"
      "'prompt': with the newest set at its end, after all earlier ones were learned.\n";
  if (!arguments.model.empty()) {
    // A model that is wrong about a steady turn is also wrong about the entry twist.
    config.limits.entry_speed = config.limits.entry_yaw_rate =
        std::numeric_limits<double>::infinity();
    notes += "The gate on the entry twist was off.\n";
  }
  std::vector<replay::LearnerRun> runs;
  config.rule.rule = "off";
  runs.push_back(replay::runLearner(log, config, replay::Commitment::kAhead, "off"));
  for (const std::string& rule : arguments.rules) {
    config.rule.rule = rule;
    if (rule != "off")
      runs.push_back(replay::runLearner(log, config, replay::Commitment::kAhead, rule));
  }
  if (arguments.rules.size() == 1 && runs.size() == 2)
    runs.push_back(replay::runLearner(log, config, replay::Commitment::kPrompt,
                                      config.rule.rule + ", prompt"));
  say(notes + "\n" + replay::reportOf(log, set, runs), arguments.output);
  if (!arguments.output.picture.empty())
    replay::drawReport(log, set, runs, arguments.output.picture);
}

void addLearner(CLI::App& app, LearnerArguments& arguments) {
  CLI::App& command = *app.add_subcommand("learner",
                                          "a log of executions through the learner. Without "
                                          "--model and --patterns a robot's own log, "
                                          "compared with its sets: code 1 if different");
  command.add_option("log", arguments.log, "LCM log with INS, MOTOR and EXECUTION")->required();
  command.add_option("--config", arguments.config,
                     "configuration of the learner for a robot's log; default: that of the log");
  auto* source = command.add_option_group("prediction", "source of the first predictions");
  source->add_option("--model", arguments.model,
                     "vehicle model file, which predicts a pattern for each pattern id of the log");
  source->add_option("--patterns", arguments.patterns, "pattern file");
  source->require_option(0, 1);
  command.add_option("--rule", arguments.rules, "rules in addition to 'off', separated by commas")
      ->delimiter(',')
      ->check(CLI::IsMember(learner::ruleNames()))
      ->capture_default_str();
  command
      .add_option("--poses", arguments.poses,
                  "SCAN_MATCHING: compare the learner's results with these poses and with "
                  "those of the INS")
      ->check(CLI::IsMember({kIns.name, kScanMatching.name}))
      ->excludes(source->get_option("--model"))
      ->excludes(source->get_option("--patterns"));
  addOutput(command, arguments.output)
      .file("--write-patterns", arguments.write_patterns,
            "write the initial set of the learner into a pattern file");
  command.callback([&arguments] {
    if (arguments.poses != kIns.name) return compareLearnedPoses(arguments);
    if (arguments.model.empty() && arguments.patterns.empty()) return compareLearner(arguments);
    replayLearner(arguments);
  });
}

struct CorpusArguments {
  std::string folder;
  std::vector<std::string> overrides;
  int threads = 1;
  Output output;
  bool different = false;
};

void addCorpus(CLI::App& app, CorpusArguments& arguments) {
  CLI::App& command = *app.add_subcommand("corpus",
                                          "all logs of a folder through planner and learner: "
                                          "differences due to the present code or another "
                                          "configuration; code 1 if there are any");
  command.add_option("folder", arguments.folder, "folder with *.lcmlog and *.mcap")->required();
  command
      .add_option("--set", arguments.overrides,
                  "PROCESS.KEY=VALUE overrides the logs' configuration, for instance "
                  "planner.margins.plan=0.1")
      ->expected(1)
      ->take_all();
  addThreads(command, arguments.threads);
  addReport(command, arguments.output);
  command.callback([&arguments] {
    const auto corpus =
        replay::replayCorpus(replay::corpusOf(arguments.folder), arguments.overrides,
                             shippedConfig() + "/patterns", arguments.threads);
    say(replay::reportOf(corpus), arguments.output);
    arguments.different =
        !std::all_of(corpus.begin(), corpus.end(), [](const auto& entry) { return entry.equal; });
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
  Arguments planner_arguments;
  CorpusArguments corpus_arguments;
  Arguments ins_arguments;
  Arguments mapping_arguments;
  Arguments matching_arguments;
  RecipeArguments recipe_arguments;
  CLI::App app{"Replays recorded logs through the real nodes on a virtual bus."};
  app.require_subcommand(0, 1);
  addRecipe(app, recipe_arguments);
  addLearner(app, learner_arguments);
  addPlanner(app, planner_arguments);
  addCorpus(app, corpus_arguments);
  addIns(app, ins_arguments);
  addMapping(app, mapping_arguments);
  addMatching(app, matching_arguments);
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  return learner_arguments.different || planner_arguments.different || corpus_arguments.different
             ? 1
             : 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("tread-replay", [&] { return parseAndRun(argc, argv); });
}
