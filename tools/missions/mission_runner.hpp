// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/log/event_log.hpp"
#include "tools/missions/mission.hpp"
#include "tools/missions/report.hpp"
#include "tools/missions/robot_system.hpp"
#include "tools/report/drive_picture.hpp"

namespace tread::missions {

/// How missions are run.
struct MissionOptions {
  std::string rule;                      ///< of learning; empty = the robot's configuration
  std::vector<learner::Rule> shadows;    ///< predict the same executions
  double shortest_line = kShortestLine;  ///< [m] see makeMissionWorld()
  FaultPlan faults;
  const TruePatterns* true_patterns = nullptr;  ///< if given: an omniscient robot drives
  LogWriter* log = nullptr;                     ///< every message, if given
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
  uint64_t seed = 1;                   ///< of the first; the others count up from it
  int threads = 1;                     ///< missions at the same time
  std::string name;                    ///< of the batch: its rule, or that it is omniscient
  std::vector<std::string> overrides;  ///< of the configuration, for the report
  MissionOptions options;              ///< of each mission; its log is set here
  std::optional<uint64_t> show;        ///< seed of the mission to draw
  std::string picture;                 ///< the file of that
  std::string log;                     ///< of the first mission; empty = none
};

/// Drives the missions; results are in the order of the seeds, lines go to stdout as they come.
Batch runBatch(const RobotConfig& robot, const BatchOrder& order);

}  // namespace tread::missions
