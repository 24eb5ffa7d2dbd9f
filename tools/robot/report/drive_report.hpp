// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/drive/drive_timeline.hpp"
#include "common/geometry/track.hpp"
#include "common/grid/grid.hpp"
#include "common/log/event_log.hpp"
#include "modules/simulator/core/world.hpp"
#include "modules/simulator/simulator_files.hpp"
#include "tools/robot/report/chronicle.hpp"
#include "tools/robot/report/hand_record.hpp"
#include "tools/robot/report/shadow_learners.hpp"

namespace tread {
class plan_tree_t;
}

namespace tread::report {

/// One branch of a search tree, in map.
struct TreeEdge {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
  bool chosen = false;
};

/// Distance of a pattern's end from its prediction.
struct PatternError {
  double time = 0.0;      ///< [s] of its end
  double position = 0.0;  ///< [m]
  double yaw = 0.0;       ///< [rad]
};

/// The same executions, predicted by a learning rule.
struct RuleSeries {
  std::string rule;
  std::vector<PatternError> errors;
};

/// A change of the true surface under the robot. A robot that turns round on a border crosses it
/// again.
struct Crossing {
  double time = 0.0;  ///< [s] since the drive began
  std::string from;
  std::string to;
};

/// The content of a drive's picture. Empty parts are left out.
struct DriveScene {
  std::string title;
  std::string name;                            ///< only in a picture of several drives
  std::optional<sim::WorldDescription> world;  ///< true ground and obstacles, if known
  TileMap map{0.1, 32};                        ///< published by mapping
  std::vector<TreeEdge> tree;
  std::vector<PoseSample> track;
  std::optional<FootprintSize> outline;  ///< of the vehicle, drawn along the track
  Pose2 T_map_start;
  Pose2 T_map_goal;
  std::vector<Eigen::Vector2d> contacts;  ///< p_map [m]
  std::vector<Eigen::Vector2d> stops;     ///< where it stopped on its path, p_map [m]
  std::vector<PatternError> errors;       ///< as driven
  std::vector<RuleSeries> by_rule;        ///< drawn as running means
  std::vector<Crossing> crossings;
  double duration = 1.0;  ///< [s]
};

/// Draws ground, map, obstacles, track and tree and the prediction error of each pattern.
/** Throws std::runtime_error with one clear line if the file cannot be written. */
void drawDrive(const std::string& path, const DriveScene& scene);

/// Draws drives through the same world side by side, each with its title, and their prediction
/// errors over time below.
/** Throws std::runtime_error with one clear line if the file cannot be written. */
void drawSideBySide(const std::string& path, const std::string& title,
                    const std::vector<DriveScene>& scenes);

/// The branches of a published tree.
std::vector<TreeEdge> edgesOf(const plan_tree_t& message);

/// The executions of one drive, predicted by several learning rules.
struct RuleErrors {
  std::string problem;  ///< the reason in one line if there are none; else empty
  std::string driven;   ///< the robot's rule during the drive
  std::vector<learner::Rule> rules;
  std::vector<report::ShadowedExecution> executions;  ///< ordered by their ends
};

/// Replays the log's INS, EXECUTION and MOTOR through a learner process for each rule.
/** Configured by the log's CONFIG of the learner, with the shipped set named there: from the log,
 * or from the pattern files of `patterns_folder`. Each starts with that set and without remembered
 * surfaces, whatever the robot had learned before. `logs`: parts of one recording, in order. */
RuleErrors errorsByRule(const std::vector<std::string>& logs, const std::string& patterns_folder,
                        const std::vector<learner::Rule>& rules);

/// Means side by side, some lines. `changes`: times of changes of ground [us], ascending; empty =
/// not known.
std::string reportOf(const RuleErrors& errors, const std::vector<int64_t>& changes);

/// A set of durations [ms].
class Durations {
 public:
  void add(double milliseconds) { values_.push_back(milliseconds); }
  size_t count() const { return values_.size(); }
  /// The value that a share (0..1) does not exceed; NaN if there is none.
  double quantile(double share) const;

 private:
  std::vector<double> values_;
};

/// Delays between related messages, by the logger's reception times.
/** INS to set: from the INS message that passes the end of an execution to the first part of the
 * set that was learned from it. Set to plan: from the last part of a set's first appearance to the
 * first PLAN made with it. Scan to tile: from SCAN to the next MAP message that holds it. */
class Latencies {
 public:
  /// `lost`: the time of reception is unknown; measures that need it are left out.
  void add(const LogEvent& event, bool lost = false);

  const Durations& insToSet() const { return ins_to_set_; }
  const Durations& setToPlan() const { return set_to_plan_; }
  const Durations& scanToTile() const { return scan_to_tile_; }

 private:
  struct Received {
    int64_t utime;     ///< [us] of the message
    int64_t received;  ///< [us] by the logger, or kLost
  };
  static constexpr int64_t kLost = std::numeric_limits<int64_t>::min();
  static void note(Durations& durations, int64_t from, int64_t to);
  void hear(const learning_t& message);
  void hear(const pattern_set_part_t& message, int64_t received);

  std::deque<Received> ins_;               ///< of recent seconds
  std::deque<Received> scans_;             ///< not yet in a tile
  std::map<int64_t, int64_t> first_part_;  ///< by version: reception of its first part
  /// by version: reception of the INS that completed its execution
  std::map<int64_t, int64_t> awaited_sets_;
  std::map<int64_t, int64_t> unplanned_;  ///< by version: reception of its last part
  std::map<int64_t, int> parts_;          ///< by version: number of parts so far
  int64_t newest_version_ = 0;
  Durations ins_to_set_, set_to_plan_, scan_to_tile_;
};

/// One drive in a log: from the first goal to the arrival, or to the end of the log.
struct DriveRecord {
  DriveTimeline log;
  bool has_goal = false;
  Pose2 T_map_goal;
  int64_t begun = 0;  ///< [us] of the first goal
  int64_t ended = 0;  ///< [us] of the arrival, else of the last INS
  bool arrived = false;
  std::string last_status;           ///< the planner's last reason
  int refused = 0;                   ///< executions that gave no fair measurement
  int disarmed = 0;                  ///< times that a permission to drive was lost
  std::vector<PatternError> errors;  ///< time since begun
  std::vector<PoseSample> track;     ///< measured by the INS, time since begun
  Odometer odometer;
  std::vector<TreeEdge> tree;            ///< the richest one on the path
  std::optional<FootprintSize> outline;  ///< of the robot; none = not in the log
  Latencies latencies;

  double sinceBegin(int64_t utime) const { return static_cast<double>(utime - begun) * 1e-6; }
  double seconds() const { return sinceBegin(ended); }
  double distance() const { return odometer.distance(); }  ///< [m] driven
  double straightLine() const;
};

/// Reads logs (parts of one recording, in order) from front to back; throws std::runtime_error.
DriveRecord readDrive(const std::vector<std::string>& logs);

/// Ground truth, known only in a simulation.
struct SimulationTruth {
  std::optional<sim::WorldDescription> world;
  std::vector<sim::TruthRow> rows;  ///< empty = no record
};

/// The report as text: one line with the result, errors as driven and by rule, delays.
std::string reportOf(const DriveRecord& drive, const SimulationTruth& truth,
                     const RuleErrors& by_rule);
/// Only the line with the result: of the first drive, and of the whole log if it has more.
std::string resultLine(const DriveRecord& drive, const SimulationTruth& truth);
/// Whether the robot arrived, also at the last goal, the log does not end in a fault or E-stop, and
/// there was no contact.
bool endedWell(const DriveRecord& drive, const SimulationTruth& truth);
/// The scene to draw.
DriveScene sceneOf(const DriveRecord& drive, const SimulationTruth& truth,
                   const RuleErrors& by_rule);

}  // namespace tread::report
