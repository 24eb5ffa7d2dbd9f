// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "modules/simulator/core/robot.hpp"
#include "modules/simulator/core/world.hpp"
#include "tools/lab/missions/world_kind.hpp"
#include "tools/robot/report/drive_report.hpp"
#include "tools/robot/report/shadow_learners.hpp"

namespace tread::missions {

/// A run against the clock, as benchmarks of navigation judge it.
/** The clock starts when the robot has moved 0.1 m. The run ends when the body's true origin is
 * within the tolerance of the goal, at the first contact, or at the limit; nothing else ends it. */
struct TimedRun {
  double tolerance = 1.0;  ///< [m]
  double limit = 100.0;    ///< [s]
  double path = 0.0;       ///< [m] length of a reference path from start to goal
};

/// What a mission takes place in: hard on purpose, the same for the same seed.
/** From start to goal at least `shortest`, at most 1.68 times that; walls whose only near gap lies
 * off the straight line, pockets that open towards the start, scattered boulders; no gap between
 * obstacles is narrower than the footprint plus 0.4 m; one to three changes of surface on the way;
 * gentle slopes. A way of the footprint's width exists. */
struct MissionWorld {
  uint64_t seed = 0;
  Pose2 T_map_start;
  Pose2 T_map_goal;
  double straight_line = 0.0;  ///< [m]
  bool line_blocked = false;   ///< the footprint cannot drive the straight line
  int surface_changes = 0;     ///< borders between surfaces that the straight line crosses: 1 to 3,
                               ///< twice as many with stretches between them
  sim::WorldDescription description;
  std::optional<TimedRun> timed;  ///< how it ends; else by the planner's word
};

/// Shortest straight line from start to goal [m].
inline constexpr double kShortestLine = 25.0;

/** `shortest` [m]: with longer lines each surface is driven for longer. Of `kind` only the ground
 * counts here: stretches on the borders, the rest of a seed's world stays as it is. */
MissionWorld makeMissionWorld(uint64_t seed, const FootprintSize& robot,
                              double shortest = kShortestLine, const WorldKind& kind = {});

/// The place of a simulator's configuration (config/simulators): its world, start and seed, with
/// this goal in map. Throws ConfigError with file:line.
/** Nothing is drawn: line_blocked and surface_changes stay as they are. */
MissionWorld readMissionWorld(const std::string& simulator_file, const Eigen::Vector2d& p_map_goal);

/// Narrowest gap between obstacles that a mission may hold [m].
constexpr double narrowestGap(const FootprintSize& robot) {
  return 2.0 * robot.half_width + 0.4;
}

/// How a mission ended. Every mission ends in exactly one of these.
enum class MissionOutcome {
  kArrived,  ///< the robot stands within the goal's tolerances (checked against the true pose)
  kRefused,  ///< the planner reported the goal unreachable, or itself blocked, for 15 s
  kIdle,     ///< nothing moved for too long
  kStopped,  ///< a failsafe kept it from going on, or the time ran out while driving
  kContact   ///< it touched an obstacle; only a timed run ends so
};

inline const char* nameOf(MissionOutcome outcome) {
  constexpr const char* kNames[] = {"arrived", "refused", "idle", "stopped", "contact"};
  return kNames[static_cast<size_t>(outcome)];
}

/// One execution of a pattern as the learner scored it, with the true surface under it.
struct ScoredExecution {
  ExecutionKey key;
  double time = 0.0;  ///< [s] of its end since the start of the mission
  std::string pattern;
  std::string surface;          ///< true surface at its end; empty if it crossed a border
  bool measured = false;        ///< accepted as a fair measurement
  std::string refusal;          ///< why not
  double error_position = 0.0;  ///< [m] at the end, against the set it was planned with
  double error_yaw = 0.0;       ///< [rad] the same, wrapped
  double path_length = 0.0;     ///< [m]
  double turned = 0.0;          ///< [rad] |net yaw| measured
  double slope = 0.0;           ///< [rad] mean inclination; NaN = not known
  Pose2 measured_end;           ///< in the frame of its start
  /// Prediction error of each of MissionResult::shadow_rules; empty where not measured.
  std::vector<report::PredictionError> by_rule;
};

using report::Crossing;
using report::TrackPoint;

/// A contact of the true footprint with a true obstacle.
struct Contact {
  double time = 0.0;         ///< [s] of the first touch
  std::string pattern;       ///< being executed; empty = none
  Pose2 T_map_body;          ///< where the body was when it was seen
  double penetration = 0.0;  ///< [m] deepest attempt
};

/// The planner changed from one side to the other.
struct Flip {
  double time = 0.0;  ///< [s] since the start of the mission
  std::string from;   ///< pattern that turned to the old side
  std::string to;     ///< and the one that turns to the new one
};

/// The robot came to rest between start and goal.
struct Stop {
  double time = 0.0;      ///< [s] since the start of the mission
  double duration = 0.0;  ///< [s] that it stood
  std::string reason;     ///< as published; empty = none
};

/// The bridge disarmed by itself: nobody else disarms in a mission.
struct Disarming {
  double time = 0.0;   ///< [s] since the start of the mission
  std::string reason;  ///< as published
};

/// What the plans of a mission promised, as means of those that were searched for and lead on.
struct PlanFigures {
  int count = 0;
  double next = 0.0;            ///< [m] sum of the standard deviations of the next pattern's end
  double end = 0.0;             ///< [m] the same of the plan's end
  std::vector<int> expansions;  ///< of each search, also of those that found nothing
  double touches = 0.0;         ///< [1] number of contacts that their risk is, over the way driven
};

/// What happened in one mission: one entry of the report, hence so many fields.
struct MissionResult {
  uint64_t seed = 0;
  MissionOutcome outcome = MissionOutcome::kStopped;
  std::string reason;          ///< in words; empty when arrived
  double time = 0.0;           ///< [s] from the goal to the end
  double begun = 0.0;          ///< [s] of that until it first moved
  double driven = 0.0;         ///< [s] of that in motion
  double distance = 0.0;       ///< [m] really driven
  double straight_line = 0.0;  ///< [m] from start to goal
  bool line_blocked = false;   ///< the straight line was not free
  int completed = 0;           ///< patterns executed to their end
  int aborted = 0;
  int rearmed = 0;           ///< times the operator had to arm again
  int64_t set_versions = 0;  ///< sets published after the first
  int surface_changes = 0;   ///< that the world has between start and goal, driven or not
  std::vector<Crossing> crossings;
  std::vector<ScoredExecution> executions;
  std::vector<learner::Rule> shadow_rules;  ///< that predicted the same executions
  std::vector<TrackPoint> track;            ///< the true poses, for pictures
  std::vector<Contact> contacts;            ///< one per collision
  std::vector<Stop> stops;                  ///< between start and arrival
  std::vector<Disarming> disarmings;
  std::vector<Flip> flips;
  PlanFigures plans;
  double least_clearance =
      std::numeric_limits<double>::infinity();  ///< [m] of the true outline to obstacles
  std::string world;                            ///< its name, where it was given
  std::optional<TimedRun> timed;                ///< how it was judged, where it was given so
  double clock = 0.0;                           ///< [s] of a timed run
  sim::Shaking smooth;  ///< how the true body was shaken on ground without bumps
  sim::Shaking rough;   ///< and on ground with them

  int collisions() const { return static_cast<int>(contacts.size()); }
  double detour() const { return straight_line > 0.0 ? distance / straight_line : 0.0; }
};

}  // namespace tread::missions
