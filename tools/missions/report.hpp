// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tools/missions/mission.hpp"

namespace tread::missions {

/// A run of missions as a whole.
struct Batch {
  uint64_t seed = 0;
  std::string rule;
  std::vector<std::string> overrides;  ///< of the robot's configuration, as they were given
  double virtual_time = 0.0;           ///< [s] sum over the missions
  double wall_time = 0.0;              ///< [s] from the first start to the last end
  double cpu_time = 0.0;               ///< [s] sum over the missions of what each took of a core
  std::vector<MissionResult> results;
};

int countOf(const Batch& batch, MissionOutcome outcome);
/// Contacts of all its missions.
int collisionsOf(const Batch& batch);

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

  double flipsPerMinute() const { return driven > 0.0 ? 60.0 * flips / driven : 0.0; }
};

Steadiness steadinessOf(const std::vector<MissionResult>& results);

/// A reason with N in the place of each number, so that equal ones can be counted.
std::string withoutNumbers(const std::string& reason);

/// One line per mission.
std::string lineOf(const MissionResult& result);

/// A line for each time the robot crossed from one surface to another, with the mean prediction
/// error before, just after and later (see ErrorsAroundChanges); empty if it never did.
std::string crossingsOf(const MissionResult& result);

/// Shares with their reasons, collisions, speed, and prediction errors before and after changes of
/// surface.
void printSummary(std::ostream& out, const Batch& batch);

/// What writeJson() writes of a batch.
nlohmann::ordered_json batchJson(const Batch& batch);

/// Throws std::runtime_error with one clear line if the file cannot be written.
void writeJsonFile(const std::string& path, const nlohmann::ordered_json& json);

/// The machine-readable report; throws std::runtime_error with one clear line if it cannot be
/// written.
/** Of each run, `surface_changes` counts the borders that lie between start and goal (1 to 3), and
 * `crossings` lists what the robot crossed: more where it turned round on a border, fewer where it
 * never came so far. */
void writeJson(const std::string& path, const Batch& batch);

}  // namespace tread::missions
