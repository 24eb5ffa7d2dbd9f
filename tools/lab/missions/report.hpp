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

}  // namespace tread::missions
