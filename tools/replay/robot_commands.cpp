// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/replay/robot_commands.hpp"

#include "tools/replay/robot_learner.hpp"
#include "tools/replay/robot_planner.hpp"

namespace tread::replay {
namespace {

learner::LearnerNodeConfig learnerConfig(const RobotLog& log, const std::string& file) {
  if (file.empty()) return learnerConfigOf(log, TREAD_CONFIG_DIR "/patterns");
  ConfigReader reader = ConfigReader::fromFile(file);
  return learner::readLearnerConfig(reader);
}

planner::PlannerConfig plannerConfig(const RobotLog& log, const std::string& file) {
  if (file.empty()) return plannerConfigOf(log);
  ConfigReader reader = ConfigReader::fromFile(file);
  return planner::readPlannerConfig(reader);
}

}  // namespace

Verdict replayRobotLearner(const std::string& log, const std::string& config) {
  const RobotLog events = readRobotLog(log);
  const LearnerCheck check = checkLearner(events, learnerConfig(events, config));
  return {reportOf(check), check.equal()};
}

Verdict replayRobotPlanner(const std::string& log, const std::string& config) {
  const RobotLog events = readRobotLog(log);
  const PlannerCheck check = checkPlanner(events, plannerConfig(events, config));
  return {reportOf(check), check.equal()};
}

}  // namespace tread::replay
