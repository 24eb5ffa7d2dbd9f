// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/log/event_log.hpp"
#include "modules/simulator/simulator_files.hpp"
#include "tools/lab/missions/mission.hpp"
#include "tools/lab/missions/prediction_errors.hpp"
#include "tools/lab/missions/robot_system.hpp"
#include "tools/robot/report/drive_report.hpp"

namespace tread::missions {

/// A batch of missions.
struct MissionBatch {
  uint64_t seed = 0;
  std::string rule;
  std::vector<std::string> overrides;  ///< of the robot's configuration, as given
  double virtual_time = 0.0;           ///< [s] sum over the missions
  double wall_time = 0.0;              ///< [s] from the first start to the last end
  double cpu_time = 0.0;               ///< [s] processor time, sum over the missions
  std::vector<MissionResult> results;
  std::optional<report::DriveScene> shown;  ///< the mission to be drawn
};

int countOf(const MissionBatch& batch, MissionOutcome outcome);
/// Contacts of all its missions.
int collisionsOf(const MissionBatch& batch);

/// Steadiness of driving.
struct Steadiness {
  double driven = 0.0;  ///< [s] in motion
  int flips = 0;
  int stops = 0;
  int most_stops = 0;      ///< in one mission
  uint64_t most_seed = 0;  ///< seed of that mission
  double stood = 0.0;      ///< [s] in all stops
  /// Count by reason; numbers in a reason are replaced by N. Empty = none was published.
  std::map<std::string, int> reasons;
  std::map<std::string, int> disarmed;  ///< the same for disarmings by the bridge itself
  int executions = 0;                   ///< scored
  std::map<std::string, int> refused;   ///< reason why they were not valid measurements

  double flipsPerMinute() const { return driven > 0.0 ? 60.0 * flips / driven : 0.0; }
};

Steadiness steadinessOf(const std::vector<MissionResult>& results);

/// A reason with N in place of each number, so that equal ones can be counted.
std::string withoutNumbers(const std::string& reason);

/// Result of one mission for a title: rule, outcome, time, stops and, if any, contacts.
std::string resultOf(const MissionBatch& batch, uint64_t seed);

/// "100 missions: 98 arrived, contacts 0"; of several batches "100 missions each: arrived off 98,
/// multi_model 98; contacts off 0, multi_model 0". `what`: "mission" or "world".
std::string outcomesOf(const std::vector<MissionBatch>& batches,
                       const std::string& what = "mission");

/// One line per mission.
std::string lineOf(const MissionResult& result);

/// One line per change of surface, with the mean prediction error before, just after and later (see
/// ErrorsAroundChanges); empty if there was none.
std::string crossingsOf(const MissionResult& result);

/// Outcomes with their reasons, collisions, speed, and prediction errors around changes of surface.
void printSummary(std::ostream& out, const MissionBatch& batch);

/// Means of errors, as JSON.
nlohmann::ordered_json errorJson(const MeanError& error);

/// JSON of a batch for writeJson().
nlohmann::ordered_json batchJson(const MissionBatch& batch);

/// Throws std::runtime_error with one clear line if the file cannot be written.
void writeJsonFile(const std::string& path, const nlohmann::ordered_json& json);

/// Writes the machine-readable report; throws std::runtime_error with one clear line if that fails.
/** Of each run, `surface_changes` counts the borders that lie between start and goal (1 to 3), and
 * `crossings` lists the borders that the robot crossed: more if it turned round on one, fewer if
 * it did not get that far. */
void writeJson(const std::string& path, const MissionBatch& batch);

/// All rules drive the same worlds, and each rule predicts the first rule's executions.
/** Batches have the same seeds; the missions of the first one carry shadow rules. This gives two
 * comparisons. Same worlds: each rule plans its own path, as on the robot. Same executions: every
 * rule predicts the first rule's drive, which removes the influence of the path. Both give the
 * number of executions until a rule is as good as the oracle (Settling). */
struct RuleComparison {
  std::vector<MissionBatch> batches;  ///< one per rule, at least one
};

/// A table with one line per rule.
void printComparison(std::ostream& out, const RuleComparison& comparison);

/// The same with all missions as JSON; throws std::runtime_error with one clear line if it cannot
/// be written.
void writeComparison(const std::string& path, const RuleComparison& comparison);

/// The same missions with the learning robot and with the omniscient one.
struct OmniscientComparison {
  MissionBatch learning;
  MissionBatch omniscient;
};

/// Time to the goal relative to that of the omniscient robot.
struct TimeRatio {
  uint64_t seed = 0;
  double learning = 0.0;    ///< [s] from the first motion to the goal
  double omniscient = 0.0;  ///< [s]
  double ratio() const { return learning / omniscient; }
};

/// For missions in which both arrive, in ascending order.
std::vector<TimeRatio> timeRatios(const OmniscientComparison& comparison);

/// Quantile of sorted ratios (nearest rank); NaN if empty.
double quantileOf(const std::vector<TimeRatio>& sorted, double share);

/// Numbers of solved missions, ratios of times, and the missions with the largest ratios.
void printOmniscient(std::ostream& out, const OmniscientComparison& comparison);

/// Both batches and all ratios; throws std::runtime_error with one line if it cannot be written.
void writeOmniscient(const std::string& path, const OmniscientComparison& comparison);

/// The same missions with different speed methods: always fast, always slow, by the seen ground,
/// the felt ground, or both.
struct SpeedComparison {
  std::vector<MissionBatch> batches;  ///< one per method, named after it
};

/// The robot's configuration with one of speedMethods().
RobotConfig withSpeedBy(const std::string& method, RobotConfig robot);
const std::vector<std::string>& speedMethods();

/// Shock, speed and time by ground, one line per method, with 95 % intervals over the missions.
void printSpeeds(std::ostream& out, const SpeedComparison& comparison);

/// The same with all missions; throws std::runtime_error with one line if it cannot be written.
void writeSpeeds(const std::string& path, const SpeedComparison& comparison);

/// Options of missions.
struct MissionOptions {
  std::string rule;                      ///< learning rule; empty = the robot's configuration
  std::vector<learner::Rule> shadows;    ///< predict the same executions
  double shortest_line = kShortestLine;  ///< [m] see makeMissionWorld()
  FaultPlan faults;
  Knowledge known;                    ///< parts of the truth that the planner gets
  LogWriter* log = nullptr;           ///< records every message, if given
  std::optional<MissionWorld> place;  ///< the world; empty = drawn by the seed
  sim::TruthRecord* truth = nullptr;  ///< records the truth, if given
};

/// World, map and search tree for the picture of a mission.
struct MissionScene {
  MissionWorld world;
  FootprintSize outline;               ///< of the robot
  TileMap map{0.1, 32};                ///< as published by mapping
  std::vector<report::TreeEdge> tree;  ///< of a plan on the way
};

struct MissionRun {
  MissionResult result;
  MissionScene scene;
  double virtual_time = 0.0;  ///< [s]
  double cpu_time = 0.0;      ///< [s] of this thread
};

/// Drives one mission of the complete robot in virtual time.
/** The operator sends the goal at 1 Hz, arms at the start, and arms again 2 s after a failsafe has
 * disarmed. */
MissionRun runMission(const RobotConfig& robot, uint64_t seed, const MissionOptions& options);

/// World, map, surfaces, true track, a tree and the prediction errors, for drawing.
report::DriveScene driveSceneOf(const MissionResult& result, const MissionScene& scene);

/// A batch of missions to run.
struct BatchOrder {
  int missions = 1;
  std::vector<MissionWorld> places;  ///< one per mission, with their seeds; empty = drawn by seeds
  uint64_t seed = 1;                 ///< first seed of drawn worlds; the others count up
  int threads = 1;                   ///< parallel missions
  std::string name;                  ///< of the batch: its rule, or "omniscient"
  std::vector<std::string> overrides;  ///< of the configuration, for the report
  MissionOptions options;              ///< of each mission; place and log are set by runBatch()
  std::optional<uint64_t> show;        ///< seed of the mission to be drawn
  std::string log;                     ///< file for the first mission; empty = none
  std::string truth;                   ///< the same: file of the truth
};

/// Drives the missions; results are in the order of the seeds, lines are printed as they come.
MissionBatch runBatch(const RobotConfig& robot, const BatchOrder& order);

}  // namespace tread::missions
