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

/// A timed run, as in navigation benchmarks.
/** The clock starts when the robot has moved 0.1 m. The run ends when the body's true origin is
 * within the tolerance of the goal, at the first contact, or at the limitand at no other event. */
struct TimedRun {
  double tolerance = 1.0;  ///< [m]
  double limit = 100.0;    ///< [s]
  double path = 0.0;       ///< [m] length of a reference path from start to goal
};

/// World of a mission: difficult on purpose, and the same for the same seed.
/** The straight line from start to goal is `shortest` to 1.68 times that long. There are walls
 * whose only nearby gap is off that line, pockets that open towards the start, scattered boulders,
 * one to three changes of surface on the way and gentle slopes. No gap between obstacles is
 * narrower than the footprint plus 0.4 m, and a path for the footprint exists. */
struct MissionWorld {
  uint64_t seed = 0;
  Pose2 T_map_start;
  Pose2 T_map_goal;
  double straight_line = 0.0;  ///< [m]
  bool line_blocked = false;   ///< the footprint cannot drive the straight line
  /// surface borders on the straight line: 1 to 3, twice as many with stretches between the
  /// surfaces
  int surface_changes = 0;
  sim::WorldDescription description;
  std::optional<TimedRun> timed;  ///< how it ends; else by the planner's status
};

/// Shortest straight line from start to goal [m].
inline constexpr double kShortestLine = 25.0;

/** `shortest` [m]: longer lines mean more driving on each surface. `kind` only changes the ground
 * here: it adds stretches on the borders, the rest of the seed's world is unchanged. */
MissionWorld makeMissionWorld(uint64_t seed, const FootprintSize& robot,
                              double shortest = kShortestLine, const WorldKind& kind = {});

/// Narrowest gap between obstacles in a mission [m].
constexpr double narrowestGap(const FootprintSize& robot) {
  return 2.0 * robot.half_width + 0.4;
}

/// How a mission ended; the cases are exclusive.
enum class MissionOutcome {
  kArrived,  ///< the robot stands within the goal's tolerances (checked against the true pose)
  kRefused,  ///< the planner reported the goal unreachable, or the robot blocked, for 15 s
  kIdle,     ///< nothing moved for too long
  kStopped,  ///< a failsafe kept it from driving on, or the time limit passed while driving
  kContact   ///< it touched an obstacle; this ends only timed runs
};

inline const char* nameOf(MissionOutcome outcome) {
  constexpr const char* kNames[] = {"arrived", "refused", "idle", "stopped", "contact"};
  return kNames[static_cast<size_t>(outcome)];
}

/// An execution with the learner's score and the true surface.
struct ScoredExecution {
  ExecutionKey key;
  double time = 0.0;  ///< [s] of its end since the start of the mission
  std::string pattern;
  std::string surface;          ///< true surface at its end; empty if it crossed a border
  bool measured = false;        ///< accepted as a valid measurement
  std::string refusal;          ///< reason, if not accepted
  double error_position = 0.0;  ///< [m] at the end, relative to the set that it was planned with
  double error_yaw = 0.0;       ///< [rad] the same, wrapped
  double path_length = 0.0;     ///< [m]
  double turned = 0.0;          ///< [rad] |net yaw| measured
  double slope = 0.0;           ///< [rad] mean inclination; NaN = unknown
  Pose2 measured_end;           ///< in the frame of its start
  /// Prediction error of each of MissionResult::shadow_rules; empty where not measured.
  std::vector<report::PredictionError> by_rule;
};

using report::Crossing;

/// A contact of the true footprint with a true obstacle.
struct Contact {
  double time = 0.0;         ///< [s] of the first contact
  std::string pattern;       ///< being executed; empty = none
  Pose2 T_map_body;          ///< body pose at the contact
  double penetration = 0.0;  ///< [m] deepest penetration
};

/// The planner switched from one side to the other.
struct Flip {
  double time = 0.0;  ///< [s] since the start of the mission
  std::string from;   ///< pattern that turned to the old side
  std::string to;     ///< pattern that turns to the new side
};

/// The robot came to rest between start and goal.
struct Stop {
  double time = 0.0;      ///< [s] since the start of the mission
  double duration = 0.0;  ///< [s] at rest
  std::string reason;     ///< as published; empty = none
};

/// The bridge disarmed by itself; nobody else disarms in a mission.
struct Disarming {
  double time = 0.0;   ///< [s] since the start of the mission
  std::string reason;  ///< as published
};

/// Predictions of a mission's plans: means over plans that were newly searched and lead on.
struct PlanFigures {
  int count = 0;
  double next = 0.0;            ///< [m] sum of the standard deviations of the next pattern's end
  double end = 0.0;             ///< [m] the same for the plan's end
  std::vector<int> expansions;  ///< of each search, including failed ones
  /// [1] expected number of contacts: the plans' risk summed over the driven path
  double touches = 0.0;
};

/// Record of one mission: one entry of the report, hence so many fields.
struct MissionResult {
  uint64_t seed = 0;
  MissionOutcome outcome = MissionOutcome::kStopped;
  std::string reason;          ///< in words; empty when arrived
  double time = 0.0;           ///< [s] from the goal to the end
  double begun = 0.0;          ///< [s] from that to the first motion
  double driven = 0.0;         ///< [s] in motion
  double distance = 0.0;       ///< [m] true path length
  double straight_line = 0.0;  ///< [m] from start to goal
  bool line_blocked = false;   ///< an obstacle is on the straight line
  int completed = 0;           ///< patterns executed completely
  int aborted = 0;
  int rearmed = 0;           ///< how often the operator had to arm again
  int64_t set_versions = 0;  ///< pattern sets published after the first
  int surface_changes = 0;   ///< in the world between start and goal, whether reached or not
  std::vector<Crossing> crossings;
  std::vector<ScoredExecution> executions;
  std::vector<learner::Rule> shadow_rules;  ///< that predicted the same executions
  std::vector<PoseSample> track;            ///< true poses, for pictures
  std::vector<Contact> contacts;            ///< one per collision
  std::vector<Stop> stops;                  ///< between start and arrival
  std::vector<Disarming> disarmings;
  std::vector<Flip> flips;
  PlanFigures plans;
  double least_clearance =
      /// [m] least distance of the true outline to obstacles
      std::numeric_limits<double>::infinity();
  std::string world;              ///< name of a given world
  std::optional<TimedRun> timed;  ///< timed run of a given world
  double clock = 0.0;             ///< [s] of a timed run
  sim::Shaking smooth;            ///< shaking of the true body on smooth ground
  sim::Shaking rough;             ///< and on rough ground

  int collisions() const { return static_cast<int>(contacts.size()); }
  double detour() const { return straight_line > 0.0 ? distance / straight_line : 0.0; }
};

}  // namespace tread::missions
