// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/missions/report.hpp"

namespace tread::missions {

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
