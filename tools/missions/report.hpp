// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "tools/missions/mission.hpp"

namespace tread::missions {

/// A run of missions as a whole.
struct Campaign {
  uint64_t seed = 0;
  std::string rule;
  std::vector<std::string> overrides;  ///< of the robot's configuration, as they were given
  double virtual_time = 0.0;           ///< [s] sum over the missions
  double wall_time = 0.0;              ///< [s] from the first start to the last end
  double cpu_time = 0.0;               ///< [s] sum over the missions of what each took of a core
  std::vector<MissionResult> results;
};

int countOf(const Campaign& campaign, Outcome outcome);
/// Contacts of all its missions.
int collisionsOf(const Campaign& campaign);

/// One line per mission.
std::string lineOf(const MissionResult& result);

/// A line for each time the robot crossed from one surface to another, with the mean prediction
/// error before, just after and later (see ErrorAroundChange); empty if it never did.
std::string crossingsOf(const MissionResult& result);

/// Shares with their reasons, collisions, speed, and prediction errors before and after changes of
/// surface.
void printSummary(std::ostream& out, const Campaign& campaign);

/// The machine-readable report; throws std::runtime_error with one clear line if it cannot be
/// written.
/** Of each run, `surface_changes` counts the borders that lie between start and goal (1 to 3), and
 * `crossings` lists what the robot crossed: more where it turned round on a border, fewer where it
 * never came so far. */
void writeJson(const std::string& path, const Campaign& campaign);

}  // namespace tread::missions
