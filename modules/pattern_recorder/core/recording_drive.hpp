// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/execution/execution_tracker.hpp"
#include "common/pattern/pattern.hpp"

namespace tread::pattern_recorder {

/// Chooses which pattern to drive next, so that each is driven often enough from its entry class,
/// and the vehicle stays near its starting point.
/** Looks several patterns ahead along joinable chains. A chain gains by the needed patterns in it,
 * most by those that are furthest behind, so that left and right alternate; it loses by its
 * duration and by ending far away. After every pattern of it standstill must be reachable within
 * the room. Patterns are indexed by their place in the set. */
class ExcitationPlanner {
 public:
  /// `room` [m]: largest distance of pattern ends from the starting point.
  /** Throws std::runtime_error if no class is at rest (steady command 0, 0), or a class is not
   * connected with it in both directions. */
  ExcitationPlanner(const PatternSet& set, double room);

  /// The best pattern to continue with from a motion class at a pose; `needed` executions by
  /// pattern.
  /** If no more are needed, the one that leads to standstill. nullopt at standstill if none is
   * needed or no pattern stays within the room. */
  std::optional<size_t> next(const std::string& motion_class, const Pose2& T_home_body,
                             const std::vector<int>& needed) const;

  /// The starting class: the first of the set that is at rest.
  const std::string& standing() const { return class_names_[standing_]; }

 private:
  /// A pattern in the search.
  struct Step {
    size_t pattern;
    size_t to;  ///< its exit class
    Pose2 T_start_end;
    double duration;  ///< [s]
  };
  /// The fastest chain from a class to standstill.
  struct Way {
    double duration = -1.0;  ///< [s]; negative = none
    Pose2 T_start_end;
    std::optional<size_t> first;  ///< its first pattern; nullopt at standstill
  };
  struct Search;

  size_t classIndex(const std::string& name) const;
  void findWays();
  void requireConnected(const PatternSet& set) const;

  double room_;
  std::vector<std::string> class_names_;
  size_t standing_ = 0;
  std::vector<std::vector<Step>> steps_;  ///< by entry class
  std::vector<Way> ways_;                 ///< by class
};

using Say = std::function<void(const std::string& line)>;

/// Progress of the recording.
struct RecordingProgress {
  std::vector<int> missing;     ///< valid executions still missing, by pattern; 0 or less = none
  std::vector<int64_t> judged;  ///< ids of the executions accepted or refused since the last step
  std::string hopeless;         ///< why a pattern cannot be recorded; empty if all can
  bool standing = false;        ///< the robot is at rest, according to the INS
};

/// Decides which pattern to drive next, so that each is recorded often enough within a room.
/** Call step() every 50 ms. Patterns are indexed by their place in the set. */
class RecordingDrive {
 public:
  enum class State { kRunning, kDone, kFailed };

  /// `room` [m] around the starting point. Throws std::runtime_error if the set cannot be driven,
  /// see ExcitationPlanner.
  RecordingDrive(const PatternSet& set, double room, int64_t run_id, Say say);

  /// `may_begin`: false keeps a robot at rest.
  void step(const RobotReadings& readings, const RecordingProgress& progress, bool may_begin);
  void stop() { tracker_.stop(); }
  void fail(const std::string& reason);

  State state() const { return state_; }
  /// Why it failed or what it waits for; empty while it drives.
  const std::string& reason() const { return reason_; }
  /// The robot has left the room: it needs a new permission to drive.
  bool leftRoom() const { return left_room_; }
  const ExecutionTracker& program() const { return tracker_; }

 private:
  void forgetUnplayed(const RobotReadings& readings);
  void drive(const RobotReadings& readings, const RecordingProgress& progress, bool may_begin);
  /// Why it must stand now, in words; empty = it may drive.
  std::string obstacle(const RobotReadings& readings);
  std::string roomExceeded(const Pose2& T_map_body);
  void begin(const RobotReadings& readings, const std::vector<int>& missing);
  void appendNext(const RobotReadings& readings, const std::vector<int>& missing);
  /// False if too many patterns in a row were driven without a needed one.
  bool gains(bool is_needed);
  Pose2 fromHome(const Pose2& T_map_body) const { return between(*T_map_home_, T_map_body); }
  /// Predicted end of the running pattern.
  Pose2 predictedEnd(const PoseReading& pose) const;
  /// Executions that are neither recorded nor in progress, by pattern.
  std::vector<int> needed(const std::vector<int>& missing) const;
  void setReason(const std::string& reason);

  PatternSet set_;
  double room_;  ///< [m]
  Say say_;
  ExcitationPlanner excitation_;
  ExecutionTracker tracker_;
  std::map<int64_t, size_t> under_way_;  ///< handed over, result pending: pattern by execution id
  std::optional<Pose2> T_map_home_;
  std::optional<int64_t> standing_since_;  ///< [us] with an empty program
  int without_gain_ = 0;                   ///< patterns handed over since one was needed
  bool left_room_ = false;
  State state_ = State::kRunning;
  std::string reason_;
};

}  // namespace tread::pattern_recorder
