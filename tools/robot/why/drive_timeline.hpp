// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/drive/drive_log.hpp"
#include "common/execution/stop_reason.hpp"
#include "common/geometry/se2.hpp"
#include "common/grid/grid.hpp"

namespace tread::why {

/// More messages than that are not lost within seconds: a broken number.
inline constexpr int64_t kMostLost = 100'000;

/// A process' state from some time on. All times are [s] since the log began.
struct HealthNote {
  double time = 0.0;
  int64_t boot = 0;  ///< differs for each start
  bool ok = true;
  std::string reason;
  int64_t received = 0, undecodable = 0, lost = 0, late = 0;
  std::map<std::string, int64_t> counters;
};

struct StateNote {
  double time = 0.0;
  int state = 0;
  Reason reason;
};

/// How an execution ended, as the learner scored it.
struct PatternNote {
  double time = 0.0;
  std::string pattern;
  bool accepted = false;
  std::string words;            ///< why it was refused, or what the rule took it for
  double position = 0.0;        ///< [m] error at the end
  double yaw = 0.0;             ///< [rad] the same
  double path = 0.0;            ///< [m] driven
  double ground_changed = 0.0;  ///< [1] probability; NaN = the rule does not say
  int surface = 0;              ///< remembered, from 1; 0 = none
};

struct InsNote {
  double time = 0.0;
  int32_t status = 0;
  Pose2 T_map_body;
  bool placed = false;
  double inclination = 0.0;  ///< [rad] against level ground; NaN unknown
};

struct GoalNote {
  double time = 0.0;
  int64_t id = 0;
  Pose2 T_map_goal;
};

struct PersonNote {
  double time = 0.0;
  std::string who;
  std::string what;
};

/// How the vehicle differs from its model from then on.
struct GapNote {
  double time = 0.0;
  std::string words;
  bool holds = true;  ///< else the vehicle is as its model again
};

/// An obstacle cell that came or went near the robot.
struct CellNote {
  double time = 0.0;
  Eigen::Vector2d p_map;
  bool came = false;
};

/// What a log holds of a drive, in the robot's time.
struct DriveTimeline {
  std::string name;
  std::string problem;  ///< one clear line of what is wrong with the log; empty if nothing is
  int64_t begun = -1;   ///< [us] of the robot's clock
  double duration = 0.0;
  std::map<std::string, std::vector<double>> heard;  ///< by channel
  std::map<std::string, std::vector<HealthNote>> health;
  std::vector<StateNote> motors;  ///< changes of motor_bridge's state or reason
  std::vector<StateNote> plans;   ///< changes of the planner's
  std::vector<StateNote> aborts;  ///< executions; state: the pattern's id
  std::vector<PatternNote> patterns;
  std::vector<InsNote> ins;  ///< every tenth of a second, and where the status changes
  std::vector<GoalNote> goals;
  std::vector<PersonNote> people;  ///< arming, disarming, E-stops, fences, marks
  std::vector<GapNote> gaps;       ///< what tread-gap watch found new
  std::vector<CellNote> cells;
  std::vector<std::pair<double, double>> battery;  ///< [s], [V] once a second

  std::map<std::string, std::string> configs;  ///< by process, the last
  std::unique_ptr<TileMap> map;                ///< at the end
  int completed = 0;
  double distance = 0.0;  ///< [m] driven

  /// Silence of a channel that overlaps a time: [from, to]; nothing if it spoke at least every
  /// `longest` seconds around it.
  struct Silence {
    double from = 0.0, to = 0.0;
    double length() const { return to - from; }
  };
  std::optional<Silence> silenceOf(const std::string& channel, double time, double longest) const;
  /// When a process was started again within these times; nothing if it was not.
  std::optional<double> restartOf(const std::string& process, double from, double to) const;
  /// When it was heard last, if that is long before the log's end.
  std::optional<double> deathOf(const std::string& process) const;
  /// Its newest note at a time; nullptr before the first.
  const HealthNote* healthAt(const std::string& process, double time) const;
  /// The first note within these times that something is wrong; nullptr if there is none.
  const HealthNote* complaintOf(const std::string& process, double from, double to) const;
  /// Of the cells near a place that became obstacles within these times, how many, and how many of
  /// these places were free again later.
  struct Ghost {
    int came = 0, went = 0;
    double gone = 0.0;  ///< [s] when the last of them went
    bool alone = true;  ///< no obstacle is there at the end of the log
  };
  Ghost ghostAt(const Eigen::Vector2d& p_map, double from, double to) const;
  /// Where the robot was; nothing before the INS knew.
  std::optional<Pose2> poseAt(double time) const;
};

/// Reads logs (parts of one recording, in order); throws std::runtime_error with one clear line if
/// one cannot be read.
DriveTimeline readTimeline(const std::vector<std::string>& logs);

}  // namespace tread::why
