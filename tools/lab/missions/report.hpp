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

/// A run of missions as a whole.
struct MissionBatch {
  uint64_t seed = 0;
  std::string rule;
  std::vector<std::string> overrides;  ///< of the robot's configuration, as they were given
  double virtual_time = 0.0;           ///< [s] sum over the missions
  double wall_time = 0.0;              ///< [s] from the first start to the last end
  double cpu_time = 0.0;               ///< [s] sum over the missions of what each took of a core
  std::vector<MissionResult> results;
  std::optional<report::DriveScene> shown;  ///< the mission that was to be drawn
};

int countOf(const MissionBatch& batch, MissionOutcome outcome);
/// Contacts of all its missions.
int collisionsOf(const MissionBatch& batch);

/// How steadily missions were driven.
struct Steadiness {
  double driven = 0.0;  ///< [s] in motion
  int flips = 0;
  int stops = 0;
  int most_stops = 0;      ///< in one mission
  uint64_t most_seed = 0;  ///< and in which
  double stood = 0.0;      ///< [s] in all stops
  /// How often each reason was given; numbers in it are written as #. Empty = none was published.
  std::map<std::string, int> reasons;
  std::map<std::string, int> disarmed;  ///< the same of disarmings by the bridge itself
  int executions = 0;                   ///< scored
  std::map<std::string, int> refused;   ///< why they were no fair measurement

  double flipsPerMinute() const { return driven > 0.0 ? 60.0 * flips / driven : 0.0; }
};

Steadiness steadinessOf(const std::vector<MissionResult>& results);

/// A reason with N in the place of each number, so that equal ones can be counted.
std::string withoutNumbers(const std::string& reason);

/// How one of its missions went, in words for a title: rule, result, time, stops and, if any,
/// contacts.
std::string resultOf(const MissionBatch& batch, uint64_t seed);

/// One line per mission.
std::string lineOf(const MissionResult& result);

/// A line for each time the robot crossed from one surface to another, with the mean prediction
/// error before, just after and later (see ErrorsAroundChanges); empty if it never did.
std::string crossingsOf(const MissionResult& result);

/// Shares with their reasons, collisions, speed, and prediction errors before and after changes of
/// surface.
void printSummary(std::ostream& out, const MissionBatch& batch);

/// Means of errors, as JSON.
nlohmann::ordered_json errorJson(const MeanError& error);

/// What writeJson() writes of a batch.
nlohmann::ordered_json batchJson(const MissionBatch& batch);

/// Throws std::runtime_error with one clear line if the file cannot be written.
void writeJsonFile(const std::string& path, const nlohmann::ordered_json& json);

/// The machine-readable report; throws std::runtime_error with one clear line if it cannot be
/// written.
/** Of each run, `surface_changes` counts the borders that lie between start and goal (1 to 3), and
 * `crossings` lists what the robot crossed: more where it turned round on a border, fewer where it
 * never came so far. */
void writeJson(const std::string& path, const MissionBatch& batch);

/// Every rule drives the same worlds; every rule also predicts the first rule's executions.
/** Batches have the same seeds; the missions of the first one carry shadow rules. Two comparisons
 * come of it. In the same worlds: each rule plans its own way, as it would on the robot. The same
 * executions: every rule predicts what the first one drove, so that luck with the way counts for
 * nothing. With both, the number of executions until a rule is as good as the omniscient one
 * (Settling). */
struct RuleComparison {
  std::vector<MissionBatch> batches;  ///< one per rule, at least one
};

/// Side by side, a line a rule.
void printComparison(std::ostream& out, const RuleComparison& comparison);

/// The same with all missions, machine-readable; throws std::runtime_error with one clear line if
/// it cannot be written.
void writeComparison(const std::string& path, const RuleComparison& comparison);

/// The same missions driven by the learning robot and by one that knows its ground.
struct OmniscientComparison {
  MissionBatch learning;
  MissionBatch omniscient;
};

/// Time to the goal of a mission over that of the omniscient robot.
struct TimeRatio {
  uint64_t seed = 0;
  double learning = 0.0;    ///< [s] from the first motion to the goal
  double omniscient = 0.0;  ///< [s]
  double ratio() const { return learning / omniscient; }
};

/// Of the missions in which both arrive, the smallest ratio first.
std::vector<TimeRatio> timeRatios(const OmniscientComparison& comparison);

/// Smallest ratio that a share of the missions does not exceed (nearest rank); NaN without any.
double quantileOf(const std::vector<TimeRatio>& sorted, double share);

/// How many each solved, ratios of times, and the missions with the largest ones.
void printOmniscient(std::ostream& out, const OmniscientComparison& comparison);

/// Both batches and all ratios; throws std::runtime_error with one line if it cannot be written.
void writeOmniscient(const std::string& path, const OmniscientComparison& comparison);

/// The same missions with the speed chosen in several ways: always fast, always slow, by what of
/// the ground was seen, felt or both.
struct SpeedComparison {
  std::vector<MissionBatch> batches;  ///< one per way, named by it
};

/// A robot's configuration that chooses its speed in a way of speedMethods().
RobotConfig withSpeedBy(const std::string& method, RobotConfig robot);
const std::vector<std::string>& speedMethods();

/// Shock, speed and time by ground, a line a way, with 95 % intervals over the missions.
void printSpeeds(std::ostream& out, const SpeedComparison& comparison);

/// The same with all missions; throws std::runtime_error with one line if it cannot be written.
void writeSpeeds(const std::string& path, const SpeedComparison& comparison);

/// How missions are run.
struct MissionOptions {
  std::string rule;                      ///< of learning; empty = the robot's configuration
  std::vector<learner::Rule> shadows;    ///< predict the same executions
  double shortest_line = kShortestLine;  ///< [m] see makeMissionWorld()
  FaultPlan faults;
  Knowledge known;                    ///< what the planner is told of the truth
  LogWriter* log = nullptr;           ///< every message, if given
  std::optional<MissionWorld> place;  ///< where to drive; empty = drawn by the seed
  sim::TruthRecord* truth = nullptr;  ///< what really happened, if given
};

/// World, map and search tree for a picture of a mission.
struct MissionScene {
  MissionWorld world;
  FootprintSize outline;               ///< of the robot
  TileMap map{0.1, 32};                ///< what mapping published
  std::vector<report::TreeEdge> tree;  ///< of a plan on the way
};

struct MissionRun {
  MissionResult result;
  MissionScene scene;
  double virtual_time = 0.0;  ///< [s]
  double cpu_time = 0.0;      ///< [s] of this thread
};

/// Drives one mission from the start to its end, everything included, in virtual time.
/** The operator's part: the goal at 1 Hz, arming at the start, and arming again 2 s after a
 * failsafe has disarmed. */
MissionRun runMission(const RobotConfig& robot, uint64_t seed, const MissionOptions& options);

/// World, map, surfaces, true track, a tree and the prediction errors, to be drawn.
report::DriveScene driveSceneOf(const MissionResult& result, const MissionScene& scene);

/// Missions to be driven one way.
struct BatchOrder {
  int missions = 1;
  std::vector<MissionWorld> places;    ///< one a mission, with their seeds; empty = drawn by seeds
  uint64_t seed = 1;                   ///< of the first drawn; the others count up from it
  int threads = 1;                     ///< missions at the same time
  std::string name;                    ///< of the batch: its rule, or that it is omniscient
  std::vector<std::string> overrides;  ///< of the configuration, for the report
  MissionOptions options;              ///< of each mission; place and log are set here
  std::optional<uint64_t> show;        ///< seed of the mission whose scene is kept
  std::string log;                     ///< of the first mission; empty = none
  std::string truth;                   ///< the same: file of what really happened
};

/// Drives the missions; results are in the order of the seeds, lines go to stdout as they come.
MissionBatch runBatch(const RobotConfig& robot, const BatchOrder& order);

}  // namespace tread::missions
