// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <iostream>
#include <optional>

#include <CLI/CLI.hpp>

#include "common/config/command_line.hpp"
#include "common/config/config_folder.hpp"
#include "common/config/outputs.hpp"
#include "common/config/scalars.hpp"
#include "common/report/text.hpp"
#include "modules/learner/core/rules/make_rule.hpp"
#include "tools/lab/missions/comparison_report.hpp"
#include "tools/lab/missions/given_worlds.hpp"
#include "tools/lab/missions/mission_runner.hpp"
#include "tools/lab/missions/mission_world.hpp"
#include "tools/lab/missions/speed_comparison.hpp"
#include "tools/lab/missions/world_report.hpp"

namespace {

using namespace tread;
using namespace tread::missions;

constexpr const char* kPicture = "mission.png";

struct Arguments {
  int missions = 1;
  uint64_t seed = 1;
  std::string world = "usual";
  std::string rule;                ///< empty = as the robot's configuration says
  std::vector<std::string> rules;  ///< to compare; empty = one rule
  double length = kShortestLine;
  std::string fault_file;
  int threads = 1;
  std::string json;
  std::optional<uint64_t> show;
  std::string picture;  ///< empty = kPicture
  std::string log;
  std::string simulator;     ///< configuration with the world; empty = drawn by the seed
  std::vector<double> goal;  ///< [m] in map, with simulator
  std::string truth;
  std::string robot = shippedConfig() + "/robots/teodor";
  std::vector<std::string> overrides;
  bool compare_omniscient = false;
  std::string worlds;               ///< file of given worlds; empty = drawn by the seeds
  std::vector<std::string> only;    ///< names of some of them; empty = all
  GivenGround ground;               ///< ground of all worlds
  std::vector<std::string> speeds;  ///< speed methods to compare; empty = as configured
};

std::string refusalOfRule(const std::string& word) {
  if (patternSourceOf(word)) return {};
  return "unknown learning rule: " + word + "; there are " + joinWords(learner::ruleNames());
}

void defineWorlds(CLI::App& app, Arguments& arguments) {
  CLI::Option* worlds =
      app.add_option("--worlds", arguments.worlds,
                     "drive the worlds of this file against the clock: \"world x y radius\" lines "
                     "as in the BARN benchmark, or YAML (tools/lab/missions/README.md)")
          ->excludes("--missions")
          ->excludes("--world")
          ->excludes("--length")
          ->excludes("--compare-omniscient")
          ->excludes("--speeds")
          ->excludes("--simulator");
  app.add_option("--only", arguments.only, "drive only these worlds of the file")
      ->delimiter(',')
      ->needs(worlds);
  app.add_option("--surface", arguments.ground.surface,
                 "ground of all worlds (default: that of each world, else tarmac)")
      ->needs(worlds);
  app.add_option("--friction", arguments.ground.friction,
                 "friction of that surface (without --surface: of ice)")
      ->check(CLI::Range(0.01, 2.0))
      ->needs(worlds);
}

void define(CLI::App& app, Arguments& arguments) {
  app.add_option("--missions", arguments.missions, "how many")->check(CLI::Range(1, 100000));
  app.add_option("--seed", arguments.seed,
                 "seed of the first mission; the others count up from it");
  app.add_option("--world", arguments.world, "kind of world (see tools/lab/missions/README.md)")
      ->check(CLI::IsMember(worldKinds()));
  CLI::Option* one =
      app.add_option("--rule", arguments.rule,
                     "learning rule (default: that of learner.yaml); with --worlds also what "
                     "--rules takes")
          ->check(CLI::Validator(refusalOfRule, "RULE"));
  CLI::Option* several =
      app.add_option(
             "--rules", arguments.rules,
             "compare rules: each drives all missions, and all predict the first one's drives; "
             "with "
             "--worlds also omniscient, RULE+true_means and RULE+true_covariances: all or part "
             "of the true patterns replace the learned ones")
          ->delimiter(',')
          ->check(CLI::Validator(refusalOfRule, "RULE"))
          ->excludes(one);
  app.add_flag("--compare-omniscient", arguments.compare_omniscient,
               "drive all missions, and again without learning: the planner gets the true "
               "patterns of the ground under the robot; prints the ratio of the times to the goal")
      ->excludes(several);
  app.add_option(
         "--speeds", arguments.speeds,
         "compare speed methods: always fast or slow, by the seen or the felt ground, or by "
         "both (learned); each drives all missions")
      ->delimiter(',')
      ->check(CLI::IsMember(speedMethods()))
      ->excludes(several);
  app.add_option("--length", arguments.length,
                 "shortest straight line to the goal [m]; longer ones stay longer on each "
                 "surface")
      ->check(CLI::Range(25.0, 300.0));
  app.add_option(
      "--faults", arguments.fault_file,
      "YAML file with faults of messages and nodes, for instance config/missions/faults.yaml");
  app.add_option("--threads", arguments.threads, "number of missions at the same time")
      ->check(CLI::Range(1, 64));
  Outputs outputs(app);
  outputs.file("--json", arguments.json, "write the report to this file");
  app.add_option("--show", arguments.show,
                 "draw the mission with this seed, with --worlds the world of this name; with "
                 "--rules each rule's drive, side by side");
  outputs.file("--picture", arguments.picture,
               std::string("file of that picture (PNG); default ") + kPicture);
  outputs.derived([&arguments] {
    const bool unnamed = arguments.show && arguments.picture.empty();
    return std::vector<std::string>{unnamed ? kPicture : ""};
  });
  outputs.file("--log", arguments.log,
               "record the mission with seed --seed as an LCM log (first rule)");
  CLI::Option* place =
      app.add_option("--simulator", arguments.simulator,
                     "one mission in the world of this configuration (config/simulators), from its "
                     "start and with its seed, to --goal")
          ->excludes("--missions")
          ->excludes("--seed")
          ->excludes("--world");
  defineWorlds(app, arguments);
  CLI::Option* goal = app.add_option("--goal", arguments.goal, "X Y in map [m]")
                          ->type_size(2)
                          ->expected(1)
                          ->needs(place);
  place->needs(goal);
  outputs.file("--truth", arguments.truth,
               "record the true motion in the mission with seed --seed (CSV)");
  app.add_option("--robot", arguments.robot, "folder with the robot's configuration files");
  app.add_option("--set", arguments.overrides,
                 "PROCESS.KEY=VALUE overrides a value in that process's file; "
                 "planner.margins.growth=0 drives without inflation by uncertainty")
      ->expected(1)
      ->take_all();
}

bool showsOneOfThem(const Arguments& arguments) {
  return !arguments.show ||
         (*arguments.show >= arguments.seed &&
          *arguments.show - arguments.seed < static_cast<uint64_t>(arguments.missions));
}

/// Only the first batch is recorded.
BatchOrder orderOf(const Arguments& arguments, const std::string& name, bool first = true) {
  BatchOrder order;
  order.missions = arguments.missions;
  order.seed = arguments.seed;
  order.threads = arguments.threads;
  order.name = name;
  order.overrides = arguments.overrides;
  order.options.shortest_line = arguments.length;
  if (!arguments.fault_file.empty()) order.options.faults = readFaultFile(arguments.fault_file);
  order.show = arguments.show;
  if (first) order.log = arguments.log;
  if (first) order.truth = arguments.truth;
  if (!arguments.simulator.empty()) {
    order.places = {readMissionWorld(arguments.simulator, {arguments.goal[0], arguments.goal[1]})};
    if (arguments.show) order.show = order.places.front().seed;
  }
  return order;
}

/// Draws one drive per batch, side by side.
void draw(const Arguments& arguments, const std::vector<const MissionBatch*>& batches) {
  if (!arguments.show) return;
  if (batches.size() == 1) {
    report::drawDrive(arguments.picture, *batches.front()->shown);
  } else {
    std::vector<report::DriveScene> scenes;
    std::string title = formatted("World %s, mission %llu", arguments.world.c_str(),
                                  static_cast<unsigned long long>(*arguments.show));
    for (const MissionBatch* batch : batches) {
      scenes.push_back(*batch->shown);
      scenes.back().title = resultOf(*batch, *arguments.show);
      title += (scenes.size() == 1 ? ": " : "; ") + scenes.back().title;
    }
    report::drawSideBySide(arguments.picture, title, scenes);
    std::cout << title << '\n';
  }
  std::cout << "picture: " << arguments.picture << std::endl;
}

MissionBatch driveLearning(const Arguments& arguments, const RobotConfig& robot) {
  const std::string rule = arguments.rule.empty() ? robot.learner.rule.rule : arguments.rule;
  BatchOrder order = orderOf(arguments, rule);
  order.options.rule = rule;
  return runBatch(robot, order);
}

void compareOmniscient(const Arguments& arguments, const RobotConfig& robot) {
  if (robot.world.changesOnTheWay())
    throw std::invalid_argument(
        "--compare-omniscient: in the world " + robot.world.name +
        " the vehicle changes on its way, so it has no single true pattern set");
  OmniscientComparison comparison;
  std::cout << "learning" << std::endl;
  comparison.learning = driveLearning(arguments, robot);
  printSummary(std::cout, comparison.learning);
  std::cout << "omniscient" << std::endl;
  const TruePatterns true_patterns(robot.learner.shipped, robot.simulated.vehicle,
                                   robot.world.surfaces);
  BatchOrder order = orderOf(arguments, "omniscient", false);
  order.options.known.patterns = &true_patterns;
  comparison.omniscient = runBatch(robot, order);
  printSummary(std::cout, comparison.omniscient);
  printOmniscient(std::cout, comparison);
  draw(arguments, {&comparison.learning, &comparison.omniscient});
  if (!arguments.json.empty()) writeOmniscient(arguments.json, comparison);
}

void compareRules(const Arguments& arguments, const RobotConfig& robot) {
  const std::vector<learner::Rule>& rules = arguments.rules;
  RuleComparison comparison;
  for (size_t i = 0; i < rules.size(); ++i) {
    const std::string& rule = arguments.rules[i];
    std::cout << "rule " << rule << std::endl;
    BatchOrder order = orderOf(arguments, rule, i == 0);
    order.options.rule = rule;
    if (i == 0) order.options.shadows = rules;
    comparison.batches.push_back(runBatch(robot, order));
  }
  printComparison(std::cout, comparison);
  std::vector<const MissionBatch*> batches;
  for (const MissionBatch& batch : comparison.batches) batches.push_back(&batch);
  draw(arguments, batches);
  if (!arguments.json.empty()) writeComparison(arguments.json, comparison);
}

void compareSpeeds(const Arguments& arguments, const RobotConfig& robot) {
  SpeedComparison comparison;
  for (const std::string& method : arguments.speeds) {
    std::cout << method << std::endl;
    BatchOrder order = orderOf(arguments, method, comparison.batches.empty());
    order.options.rule = arguments.rule;
    comparison.batches.push_back(runBatch(withSpeedBy(method, robot), order));
  }
  printSpeeds(std::cout, comparison);
  std::vector<const MissionBatch*> batches;
  for (const MissionBatch& batch : comparison.batches) batches.push_back(&batch);
  draw(arguments, batches);
  if (!arguments.json.empty()) writeSpeeds(arguments.json, comparison);
}

/// True patterns for the worlds' surfaces; built-in ones unless the worlds define their own.
TruePatterns truePatternsIn(const std::vector<MissionWorld>& worlds, const RobotConfig& robot) {
  std::vector<sim::SurfaceParameters> surfaces;
  for (const MissionWorld& world : worlds)
    for (const sim::SurfaceParameters& own : world.description.surfaces) {
      const auto same = [&](const auto& other) { return other.name == own.name; };
      if (std::none_of(surfaces.begin(), surfaces.end(), same)) surfaces.push_back(own);
    }
  return {robot.learner.shipped, robot.simulated.vehicle, surfaces};
}

const MissionWorld& worldNamed(const std::string& name, const std::vector<MissionWorld>& worlds) {
  for (const MissionWorld& world : worlds)
    if (world.description.name == name) return world;
  throw std::invalid_argument("--show " + name + ": no world of that name is driven");
}

void driveGivenWorlds(Arguments arguments, const RobotConfig& robot) {
  std::vector<std::string> words = arguments.rules;
  if (words.empty()) words = {arguments.rule.empty() ? robot.learner.rule.rule : arguments.rule};
  std::vector<MissionWorld> worlds =
      readGivenWorlds(arguments.worlds, arguments.only, arguments.ground);
  for (MissionWorld& world : worlds) world.seed += arguments.seed;
  if (arguments.show) arguments.show = worldNamed(std::to_string(*arguments.show), worlds).seed;
  std::optional<TruePatterns> truth;
  std::vector<MissionBatch> batches;
  for (const std::string& word : words) {
    const PatternSource source = *patternSourceOf(word);
    std::cout << source.name << std::endl;
    BatchOrder order = orderOf(arguments, source.name, batches.empty());
    order.missions = static_cast<int>(worlds.size());
    order.places = worlds;
    order.options.rule = source.rule;
    if (source.truth) {
      if (!truth) truth = truePatternsIn(worlds, robot);
      order.options.known = {&*truth, *source.truth};
    }
    batches.push_back(runBatch(robot, order));
  }
  printWorlds(std::cout, batches);
  std::vector<const MissionBatch*> driven;
  for (const MissionBatch& batch : batches) driven.push_back(&batch);
  draw(arguments, driven);
  if (!arguments.json.empty()) writeWorlds(arguments.json, batches);
}

/// Options that need given worlds are refused without them.
void refuseTruth(const Arguments& arguments) {
  std::vector<std::string> words = arguments.rules;
  if (!arguments.rule.empty()) words.push_back(arguments.rule);
  for (const std::string& word : words)
    if (patternSourceOf(word)->truth)
      throw std::invalid_argument(word + " needs --worlds; without it use --compare-omniscient");
}

void drive(const Arguments& arguments) {
  if (!arguments.worlds.empty())
    return driveGivenWorlds(arguments, readRobot(arguments.robot, arguments.overrides));
  refuseTruth(arguments);
  if (!showsOneOfThem(arguments))
    throw std::invalid_argument("--show: the seed is not among those of --seed and --missions");
  RobotConfig robot = readRobot(arguments.robot, arguments.overrides);
  enterWorld(robot, arguments.world);
  if (!arguments.rules.empty()) return compareRules(arguments, robot);
  if (!arguments.speeds.empty()) return compareSpeeds(arguments, robot);
  if (arguments.compare_omniscient) return compareOmniscient(arguments, robot);
  const MissionBatch batch = driveLearning(arguments, robot);
  printSummary(std::cout, batch);
  draw(arguments, {&batch});
  if (!arguments.json.empty()) writeJson(arguments.json, batch);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Drives seeded missions of the complete robot on changing ground, in virtual time.",
               "tread-missions"};
  Arguments arguments;
  define(app, arguments);
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  return runProgram("tread-missions", [&] {
    // --show alone selects that mission.
    if (arguments.show && arguments.worlds.empty() && app.count("--seed") == 0 &&
        arguments.missions == 1)
      arguments.seed = *arguments.show;
    if (arguments.picture.empty()) arguments.picture = kPicture;
    drive(arguments);
    return 0;
  });
}
