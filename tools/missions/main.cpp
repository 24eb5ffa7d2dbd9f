// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <atomic>
#include <chrono>
#include <cmath>
#include <iostream>
#include <mutex>
#include <optional>
#include <thread>

#include <CLI/CLI.hpp>

#include "tools/missions/comparison_report.hpp"
#include "tools/missions/fault_file.hpp"
#include "tools/missions/mission_runner.hpp"
#include "tools/missions/report.hpp"

namespace {

using namespace tread;
using namespace tread::missions;

struct Arguments {
  int missions = 1;
  uint64_t seed = 1;
  std::string rule;                ///< empty = as the robot's configuration says
  std::vector<std::string> rules;  ///< to compare; empty = one rule
  bool only_first_drives = false;
  double length = kShortestLine;
  std::string fault_file;
  int threads = 1;
  std::string json;
  std::optional<uint64_t> show;
  std::string picture = "mission.png";
  std::string log;
  std::string robot = TREAD_CONFIG_DIR "/robots/teodor";
  bool live = false;
};

void define(CLI::App& app, Arguments& arguments) {
  app.add_option("--missions", arguments.missions, "how many")->check(CLI::Range(1, 100000));
  app.add_option("--seed", arguments.seed, "seed of the first one; the others count up from it");
  CLI::Option* one =
      app.add_option("--rule", arguments.rule, "rule of learning (default: as in learner.yaml)")
          ->check(CLI::IsMember(learner::ruleNames()));
  app.add_option("--rules", arguments.rules,
                 "compare rules: each drives all missions, and all judge the first one's drives")
      ->delimiter(',')
      ->check(CLI::IsMember(learner::ruleNames()))
      ->excludes(one);
  app.add_flag("--first-drives", arguments.only_first_drives,
               "with --rules: only the first rule drives, the others judge its executions");
  app.add_option(
         "--length", arguments.length,
         "shortest straight line to the goal [m]; longer ones give longer stretches of each "
         "surface")
      ->check(CLI::Range(25.0, 300.0));
  app.add_option("--faults", arguments.fault_file, "YAML file with faults of messages and nodes");
  app.add_option("--threads", arguments.threads, "missions at the same time")
      ->check(CLI::Range(1, 64));
  app.add_option("--json", arguments.json, "write the report to this file");
  app.add_option("--show", arguments.show, "draw the mission with this seed");
  app.add_option("--picture", arguments.picture, "file of that picture (PNG)");
  app.add_option("--log", arguments.log,
                 "record the mission with seed --seed as an LCM log (first rule)");
  app.add_option("--robot", arguments.robot, "folder with the robot's configuration files");
  app.add_flag("--live", arguments.live, "tell each second of virtual time");
}

void printProgress(const Progress& progress) {
  char line[300];
  std::snprintf(line, sizeof line, "%6.0f s  %5.1f m to go  %-7s %-14s %s", progress.time,
                progress.to_go, progress.surface.c_str(),
                progress.pattern.empty() ? "-" : progress.pattern.c_str(), progress.plan.c_str());
  std::cout << line;
  if (std::isfinite(progress.last_error))
    std::cout << "  last error " << std::llround(100.0 * progress.last_error) << " cm";
  std::cout << std::endl;
}

/// Runs the missions with one rule on some threads; results in the order of the seeds.
class Campaigner {
 public:
  /// `shadows`: judge the same executions. `first`: the rule whose drives are drawn and recorded.
  Campaigner(const Arguments& arguments, const RobotConfig& robot, std::string rule,
             std::vector<learner::Rule> shadows, bool first)
      : arguments_(arguments),
        robot_(robot),
        rule_(std::move(rule)),
        shadows_(std::move(shadows)),
        first_(first) {
    if (!arguments.fault_file.empty()) faults_ = readFaultFile(arguments.fault_file);
  }

  Campaign run() {
    Campaign campaign;
    campaign.seed = arguments_.seed;
    campaign.rule = rule_;
    campaign.results.resize(static_cast<size_t>(arguments_.missions));
    const auto started = std::chrono::steady_clock::now();
    std::vector<std::thread> threads;
    for (int i = 0; i < arguments_.threads; ++i) threads.emplace_back([&] { work(campaign); });
    for (std::thread& thread : threads) thread.join();
    if (error_) std::rethrow_exception(error_);
    campaign.wall_time =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    return campaign;
  }

 private:
  void work(Campaign& campaign) {
    try {
      for (int i = next_++; i < arguments_.missions; i = next_++) {
        MissionRun run = drive(arguments_.seed + static_cast<uint64_t>(i));
        const std::lock_guard<std::mutex> lock(mutex_);
        campaign.virtual_time += run.virtual_time;
        campaign.cpu_time += run.cpu_time;
        std::cout << lineOf(run.result) << '\n' << crossingsOf(run.result) << std::flush;
        campaign.results[static_cast<size_t>(i)] = std::move(run.result);
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      error_ = std::current_exception();
      next_ = arguments_.missions;
    }
  }

  MissionRun drive(uint64_t seed) {
    MissionOptions options;
    options.rule = rule_;
    options.shadows = shadows_;
    options.shortest_line = arguments_.length;
    options.faults = faults_;
    if (arguments_.live) options.progress = printProgress;
    std::optional<LogWriter> log;
    if (first_ && !arguments_.log.empty() && seed == arguments_.seed)
      options.log = &log.emplace(arguments_.log);
    MissionRun run = runMission(robot_, seed, options);
    if (log) log->flush();
    if (first_ && arguments_.show == seed) {
      picture::drawDrive(arguments_.picture, driveSceneOf(run.result, run.scene));
      const std::lock_guard<std::mutex> lock(mutex_);
      std::cout << "picture: " << arguments_.picture << std::endl;
    }
    return run;
  }

  const Arguments& arguments_;
  const RobotConfig& robot_;
  std::string rule_;
  std::vector<learner::Rule> shadows_;
  bool first_;
  FaultPlan faults_;
  std::atomic<int> next_{0};
  std::mutex mutex_;
  std::exception_ptr error_;
};

bool showsOneOfThem(const Arguments& arguments) {
  return !arguments.show ||
         (*arguments.show >= arguments.seed &&
          *arguments.show - arguments.seed < static_cast<uint64_t>(arguments.missions));
}

void driveOneRule(const Arguments& arguments, const RobotConfig& robot) {
  const std::string rule =
      arguments.rule.empty() ? learner::ruleName(robot.learner.rule.rule) : arguments.rule;
  const Campaign campaign = Campaigner(arguments, robot, rule, {}, true).run();
  printSummary(std::cout, campaign);
  if (!arguments.json.empty()) writeJson(arguments.json, campaign);
}

void compareRules(const Arguments& arguments, const RobotConfig& robot) {
  std::vector<learner::Rule> rules;
  for (const std::string& name : arguments.rules) rules.push_back(*learner::ruleNamed(name));
  Comparison comparison;
  for (size_t i = 0; i < rules.size(); ++i) {
    const bool first = i == 0;
    if (!first && arguments.only_first_drives) break;
    std::cout << "rule " << arguments.rules[i] << std::endl;
    comparison.campaigns.push_back(Campaigner(arguments, robot, arguments.rules[i],
                                              first ? rules : std::vector<learner::Rule>{}, first)
                                       .run());
  }
  printComparison(std::cout, comparison);
  if (!arguments.json.empty()) writeComparison(arguments.json, comparison);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Drives seeded missions in virtual time: the whole robot on changing ground.",
               "tread-missions"};
  Arguments arguments;
  define(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? 0 : 2;
  }
  try {
    // --show alone means: that mission.
    if (arguments.show && app.count("--seed") == 0 && arguments.missions == 1)
      arguments.seed = *arguments.show;
    if (!showsOneOfThem(arguments))
      throw std::invalid_argument("--show: the seed is not among those of --seed and --missions");
    const RobotConfig robot = readRobot(arguments.robot);
    if (arguments.rules.empty())
      driveOneRule(arguments, robot);
    else
      compareRules(arguments, robot);
  } catch (const std::exception& error) {
    std::cerr << "tread-missions: " << error.what() << std::endl;
    return 1;
  }
  return 0;
}
