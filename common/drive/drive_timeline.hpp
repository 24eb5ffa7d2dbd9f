// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/drive/drive_log.hpp"
#include "common/drive/event_teller.hpp"
#include "common/drive/odometer.hpp"
#include "common/execution/stop_reason.hpp"
#include "common/geometry/se2.hpp"
#include "common/grid/grid.hpp"
#include "common/pattern/command.hpp"

namespace tread {

/// A message with new content, as received.
template <class Message>
struct Said : Note {
  Message message;
};

/// What motor_bridge did, until its state, its reason or the command changed.
struct MotorNote : Note {
  int64_t utime = 0, until = 0;  ///< [us] of the first and the last message with it
  int16_t state = 0;             ///< motor_t::STATE_*
  Reason reason;
  Command command;
};

/// The loss of a permission to drive with its fault, or an emergency stop.
struct PermissionLoss : Note {
  int16_t state = 0;  ///< motor_t::STATE_* after the loss
  Reason reason;
  bool had_it = true;  ///< false: an emergency stop without a permission
};

struct PlanNote : Note {
  int64_t utime = 0;  ///< [us]
  int16_t state = 0;  ///< plan_t::PLAN_*
  Reason reason;      ///< while it drives: of a planned stop
  int64_t goal_id = 0;
  bool news = false;                ///< the driving state or the reason for standing changed
  std::optional<Pose2> T_map_next;  ///< end of its first pattern; nullopt: no plan
  int64_t duration = 0;             ///< [us] of that pattern; 0 before its set is known
};

struct EventNote : Note {
  Event said;
};

/// Difference of the vehicle from its model from then on.
struct GapNote : Note {
  std::string words;
  bool holds = true;  ///< false: the vehicle agrees with its model again
};

/// An obstacle cell that appeared or disappeared near the robot.
struct CellNote : Note {
  Eigen::Vector2d p_map;
  bool came = false;
};

/// The drive in a log, in robot time. All times are [s] since the log began.
struct DriveTimeline {
  std::string name;
  std::string problem;  ///< the log's problems in one line; empty if there are none
  int64_t begun = -1;   ///< [us] of the robot's clock
  double duration = 0.0;
  size_t messages = 0;
  std::map<std::string, std::vector<double>> heard;  ///< by channel, without HEALTH
  std::map<std::string, std::vector<Said<health_t>>> health;
  std::vector<MotorNote> motors;
  std::vector<PermissionLoss> losses;
  std::vector<PlanNote> plans;                       ///< each
  std::vector<Said<execution_record_t>> executions;  ///< the completed ones, each once
  std::vector<Said<learning_t>> patterns;            ///< their results, as scored by the learner
  std::vector<InsNote> ins;
  std::vector<Said<goal_t>> goals;
  std::vector<EventNote> events;  ///< changes and actions of people, in words
  std::vector<GapNote> gaps;      ///< changes reported by tread-gap watch
  std::vector<CellNote> cells;
  std::vector<std::pair<double, double>> battery;  ///< [s], [V] once a second

  std::map<std::string, std::string> configs;  ///< by process, the latest
  std::unique_ptr<TileMap> map;                ///< at the end
  double distance = 0.0;                       ///< [m] driven

  /// Number of executions with this outcome (execution_record_t::OUTCOME_*).
  int ended(int16_t outcome) const;
  /// Silence of a channel that overlaps a time: [from, to]; nullopt if it was heard at least every
  /// `longest` seconds around it.
  struct Silence {
    double from = 0.0, to = 0.0;
    double length() const { return to - from; }
  };
  std::optional<Silence> silenceOf(const std::string& channel, double time, double longest) const;
  /// When a process was restarted within these times; nullopt if it was not.
  std::optional<double> restartOf(const std::string& process, double from, double to) const;
  /// Its last HEALTH, if that is long before the log's end.
  std::optional<double> deathOf(const std::string& process) const;
  /// Its newest HEALTH at a time; nullptr before the first.
  const Said<health_t>* healthAt(const std::string& process, double time) const;
  /// Its first HEALTH within these times that reports a fault; nullptr if none does.
  const Said<health_t>* complaintOf(const std::string& process, double from, double to) const;
  /// Of the cells near a place that became obstacles within these times: their number, and how many
  /// of them were free again later.
  struct Ghost {
    int came = 0, went = 0;
    double gone = 0.0;  ///< [s] when the last of them disappeared
    bool alone = true;  ///< no obstacle is there at the end of the log
  };
  Ghost ghostAt(const Eigen::Vector2d& p_map, double from, double to) const;
  /// Pose of the robot; nullopt before the INS's first.
  std::optional<Pose2> poseAt(double time) const;
};

inline bool isOk(const health_t& health) {
  return health.health_state == health_t::HEALTH_OK;
}
/// Why the learner refused a pattern, or its rule's interpretation.
inline const std::string& wordsOf(const learning_t& learning) {
  return learning.accepted ? learning.change_reason : learning.gate_reason;
}

/// The notes of the events from one (inclusive) to another (exclusive): [begin, end).
template <class Kind>
auto notesBetween(const std::vector<Kind>& notes, size_t from, size_t to) {
  const auto at = [&](size_t number) {
    return std::lower_bound(notes.begin(), notes.end(), number,
                            [](const Kind& note, size_t event) { return note.event < event; });
  };
  return std::pair(at(from), at(to));
}

/// Called after each event with the timeline so far.
using EachEvent = std::function<void(const DriveEvent&, const DriveTimeline&)>;

/// Reads a log to its end. `ins_step` [s]: INS messages at a higher rate are noted only if their
/// status differs.
DriveTimeline timelineOf(DriveReader reader, double ins_step = 0.0, const EachEvent& each = {});
/// The same for files (parts of one recording, in order). Throws std::runtime_error with one clear
/// line if a file cannot be read or contains no message of Tread.
DriveTimeline readTimeline(const std::vector<std::string>& logs, double ins_step = 0.0);

}  // namespace tread
