// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The report's comparison of rules, from the log of a drive.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstdio>

#include <unistd.h>

#include "tools/lab/missions/mission_runner.hpp"
#include "tools/robot/report/drive_report.hpp"

using namespace tread;

namespace {

const std::string kConfigFolder = TREAD_SOURCE_DIR "/config";

}  // namespace

TEST_CASE("a log tells what each rule would have predicted, as shadows of the drive do") {
  const std::vector<learner::Rule> rules{"off", "collective", "multi_model"};
  const std::string path = "test_rule_errors_" + std::to_string(getpid()) + ".lcmlog";
  missions::MissionRun run;
  {
    LogWriter log(path);
    missions::MissionOptions options;
    options.rule = "collective";
    options.shadows = rules;
    options.log = &log;
    run = missions::runMission(missions::readRobot(kConfigFolder + "/robots/teodor"), 22, options);
  }
  const report::RuleErrors errors =
      report::errorsByRule({path}, kConfigFolder + "/patterns", rules);
  std::remove(path.c_str());
  REQUIRE(errors.problem.empty());
  CHECK(errors.driven == "collective");
  std::map<ExecutionKey, std::vector<report::PredictionError>> in_log;
  for (const report::ShadowedExecution& execution : errors.executions)
    in_log[execution.key] = execution.by_rule;
  int compared = 0, equal = 0;
  for (const missions::ScoredExecution& execution : run.result.executions) {
    if (!execution.measured) continue;
    const std::vector<report::PredictionError>& replayed = in_log[execution.key];
    REQUIRE(replayed.size() == rules.size());
    for (size_t rule = 0; rule < rules.size(); ++rule, ++compared)
      equal += std::abs(replayed[rule].position - execution.by_rule[rule].position) < 1e-6 ? 1 : 0;
  }
  CHECK(compared > 45);
  CHECK(equal >= compared - 6);  // a log's clock may shift a set by a step

  const std::string words = report::reportOf(errors, {errors.executions[10].ended});
  for (const char* word :
       {"off ", "collective ", "multi_model ", "1..3 after it", "driven: collective"})
    CHECK(words.find(word) != std::string::npos);
  CHECK(report::reportOf(errors, {}).find("1..3 after it") == std::string::npos);
}

TEST_CASE("a log without a learner gives no comparison, and the reason") {
  const std::string path = "test_rule_errors_none_" + std::to_string(getpid()) + ".lcmlog";
  {
    LogWriter log(path);
    goal_t goal{};
    goal.utime = 1'000'000;
    log.write(kGoal, goal);
  }
  const report::RuleErrors errors =
      report::errorsByRule({path}, kConfigFolder + "/patterns", {"off"});
  std::remove(path.c_str());
  CHECK(errors.problem.find("no CONFIG of the learner") != std::string::npos);
  CHECK(report::reportOf(errors, {}).find("no CONFIG of the learner") != std::string::npos);
}
