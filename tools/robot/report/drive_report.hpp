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
#include "common/geometry/se2.hpp"
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

/// Where the vehicle was at a time.
struct TrackPoint {
  double time = 0.0;  ///< [s] since the drive began
  Pose2 T_map_body;
};

/// How far a pattern ended from its prediction.
struct PatternError {
  double time = 0.0;      ///< [s] of its end
  double position = 0.0;  ///< [m]
  double yaw = 0.0;       ///< [rad]
};

/// The same executions, predicted by a rule of learning.
struct RuleSeries {
  std::string rule;
  std::vector<PatternError> errors;
};

/// A change of the true surface under the robot. Who turns round on a border crosses it again.
struct Crossing {
  double time = 0.0;  ///< [s] since the drive began
  std::string from;
  std::string to;
};

/// All that a picture of a drive shows. What is empty is left out.
struct DriveScene {
  std::string title;
  std::string name;                            ///< in a picture of several; may be empty
  std::optional<sim::WorldDescription> world;  ///< true ground and obstacles, if they are known
  TileMap map{0.1, 32};                        ///< what mapping published
  std::vector<TreeEdge> tree;
  std::vector<TrackPoint> track;
  std::optional<FootprintSize> outline;  ///< of the vehicle, drawn along the track
  Pose2 T_map_start;
  Pose2 T_map_goal;
  std::vector<Eigen::Vector2d> contacts;  ///< p_map [m]
  std::vector<Eigen::Vector2d> stops;     ///< where it came to rest on its way, p_map [m]
  std::vector<PatternError> errors;       ///< as driven
  std::vector<RuleSeries> by_rule;        ///< drawn as running means
  std::vector<Crossing> crossings;
  double duration = 1.0;  ///< [s]
};

/// Draws ground, map, obstacles, track and tree beside the prediction error of each pattern.
/** Throws std::runtime_error with one clear line if the file cannot be written. */
void drawDrive(const std::string& path, const DriveScene& scene);

/// Draws drives through the same world side by side, each under its title, and the prediction
/// errors of all over time below.
/** Throws std::runtime_error with one clear line if the file cannot be written. */
void drawSideBySide(const std::string& path, const std::string& title,
                    const std::vector<DriveScene>& scenes);

/// The branches of a tree as it is published.
std::vector<TreeEdge> edgesOf(const plan_tree_t& message);

/// The executions of one drive, predicted by several rules of learning.
struct RuleErrors {
  std::string problem;  ///< why there are none, one line; empty = there are
  std::string driven;   ///< rule that the robot drove with
  std::vector<learner::Rule> rules;
  std::vector<report::ShadowedExecution> executions;  ///< in the order in which they ended
};

/// Replays the log's INS, EXECUTION and MOTOR through a learner process for each rule.
/** Configured as the log's CONFIG of the learner says, with the shipped set that it names: in the
 * log, or among the pattern files of `patterns_folder`. Each begins with that set and remembers no
 * surface, whatever the robot had learned before. `logs`: parts of one recording, in order. */
RuleErrors errorsByRule(const std::vector<std::string>& logs, const std::string& patterns_folder,
                        const std::vector<learner::Rule>& rules);

/// Means side by side, some lines. `changes`: when the ground became another [us], ascending;
/// empty = not known.
std::string reportOf(const RuleErrors& errors, const std::vector<int64_t>& changes);

/// Times that something took [ms].
class Durations {
 public:
  void add(double milliseconds) { values_.push_back(milliseconds); }
  size_t count() const { return values_.size(); }
  /// The value that a share (0..1) does not exceed; NaN if there is none.
  double quantile(double share) const;

 private:
  std::vector<double> values_;
};

/// How long messages wait for each other, by the times at which the logger received them.
/** INS to set: from the INS message that passes the end of an execution to the first part of the
 * set that was learned from it. Set to plan: from the last part of a set's first appearance to the
 * first PLAN made with it. Scan to tile: from SCAN to the next MAP message that holds it. */
class Latencies {
 public:
  /// `lost`: the log does not say when the event was received; what needs that is left out.
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

  std::deque<Received> ins_;                 ///< of the last seconds
  std::deque<Received> scans_;               ///< not yet in a tile
  std::map<int64_t, int64_t> first_part_;    ///< by version: when its first part came
  std::map<int64_t, int64_t> awaited_sets_;  ///< by version: when the INS came that allowed it
  std::map<int64_t, int64_t> unplanned_;     ///< by version: when it was complete
  std::map<int64_t, int> parts_;             ///< by version: parts so far
  int64_t newest_version_ = 0;
  Durations ins_to_set_, set_to_plan_, scan_to_tile_;
};

/// One drive in a log: from the first goal to the arrival, or to the log's end.
struct DriveRecord {
  DriveTimeline log;
  bool has_goal = false;
  Pose2 T_map_goal;
  int64_t begun = 0;  ///< [us] of the first goal
  int64_t ended = 0;  ///< [us] of the arrival, else of the last INS
  bool arrived = false;
  std::string last_status;           ///< the planner's last reason
  int refused = 0;                   ///< executions that were no fair measurement
  int disarmed = 0;                  ///< times that a permission to drive was lost
  std::vector<PatternError> errors;  ///< time since begun
  std::vector<TrackPoint> track;     ///< as the INS measured, time since begun
  Odometer odometer;
  std::vector<TreeEdge> tree;            ///< the richest one on the way
  std::optional<FootprintSize> outline;  ///< of the robot; none = the log does not say
  Latencies latencies;

  double sinceBegin(int64_t utime) const { return static_cast<double>(utime - begun) * 1e-6; }
  double seconds() const { return sinceBegin(ended); }
  double distance() const { return odometer.distance(); }  ///< [m] driven
  double straightLine() const;
};

/// Reads logs (parts of one recording, in order) from front to back; throws std::runtime_error.
DriveRecord readDrive(const std::vector<std::string>& logs);

/// Ground truth, known in a simulation only.
struct SimulationTruth {
  std::optional<sim::WorldDescription> world;
  std::vector<sim::TruthRow> rows;  ///< empty = no record
};

/// The report as text: the result in one line, errors as driven and by rule, latencies.
std::string reportOf(const DriveRecord& drive, const SimulationTruth& truth,
                     const RuleErrors& by_rule);
/// The one line of result alone: of the first drive, and of the whole log where there is more.
std::string resultLine(const DriveRecord& drive, const SimulationTruth& truth);
/// Whether the robot arrived, at the last goal, too, and the log ends in no fault or E-stop;
/// nothing was touched.
bool endedWell(const DriveRecord& drive, const SimulationTruth& truth);
/// The drive to be drawn.
DriveScene sceneOf(const DriveRecord& drive, const SimulationTruth& truth,
                   const RuleErrors& by_rule);

}  // namespace tread::report
