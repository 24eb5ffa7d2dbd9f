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

/// Chooses which pattern to drive next, so that each is driven often enough, entered in its class,
/// and the vehicle stays near where it began.
/** Looks several patterns ahead along joinable chains. A chain counts what it drives of patterns
 * that are needed, those that lag behind most, which makes left and right take turns; it loses by
 * time and by ending far away. Every pattern of it leaves a way to standing within the room.
 * Patterns are given by their place in the set. */
class ExcitationPlanner {
 public:
  /// `room` [m]: distance from where it began that ends of patterns keep.
  /** Throws std::runtime_error if no class stands still (steady command 0, 0), or a class cannot be
   * reached from there or left for it. */
  ExcitationPlanner(const PatternSet& set, double room);

  /// The best pattern to join to a motion class at a pose; `needed` executions by pattern.
  /** Where nothing is needed any more, the one that leads to standing. Nothing where it stands and
   * either nothing is needed or no pattern stays within the room. */
  std::optional<size_t> next(const std::string& motion_class, const Pose2& T_home_body,
                             const std::vector<int>& needed) const;

  /// The class in which to begin: the first of the set that stands still.
  const std::string& standing() const { return class_names_[standing_]; }

 private:
  /// A pattern as the search sees it.
  struct Step {
    size_t pattern;
    size_t to;  ///< class in which it ends
    Pose2 T_start_end;
    double duration;  ///< [s]
  };
  /// The quickest way from a class to standing.
  struct Way {
    double duration = -1.0;  ///< [s]; negative = none
    Pose2 T_start_end;
    std::optional<size_t> first;  ///< pattern to begin with; nothing where it stands already
  };
  struct Search;

  size_t classIndex(const std::string& name) const;
  void findWays();
  void requireConnected(const PatternSet& set) const;

  double room_;
  std::vector<std::string> class_names_;
  size_t standing_ = 0;
  std::vector<std::vector<Step>> steps_;  ///< by class in which they begin
  std::vector<Way> ways_;                 ///< by class
};

using Say = std::function<void(const std::string& line)>;

/// What has been measured so far.
struct RecordingProgress {
  std::vector<int> missing;     ///< fair executions still missing, by pattern; 0 or less = none
  std::vector<int64_t> judged;  ///< ids of the executions measured or refused since the last step
  std::string hopeless;         ///< why a pattern cannot be recorded; empty if none is known
  bool standing = false;        ///< the INS says that the robot stands
};

/// Decides which pattern to drive next, so that each is recorded often enough within a room.
/** Needs one call of step() every 50 ms. Patterns are given by their place in the set. */
class RecordingDrive {
 public:
  enum class State { kRunning, kDone, kFailed };

  /// `room` [m] around the place where it begins. Throws std::runtime_error if the set cannot be
  /// driven, see ExcitationPlanner.
  RecordingDrive(const PatternSet& set, double room, int64_t run_id, Say say);

  /// `may_begin`: false keeps a standing robot standing.
  void step(const RobotReadings& readings, const RecordingProgress& progress, bool may_begin);
  void stop() { tracker_.stop(); }
  void fail(const std::string& reason);

  State state() const { return state_; }
  /// Why it failed or what it waits for; empty while it drives.
  const std::string& reason() const { return reason_; }
  /// The robot is outside the room: the permission to drive must be given anew.
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
  /// False if too many patterns were driven in a row without one that is needed.
  bool gains(bool is_needed);
  Pose2 fromHome(const Pose2& T_map_body) const { return between(*T_map_home_, T_map_body); }
  /// Where the running pattern is predicted to end.
  Pose2 predictedEnd(const PoseReading& pose) const;
  /// Executions that are neither recorded nor under way, by pattern.
  std::vector<int> needed(const std::vector<int>& missing) const;
  void setReason(const std::string& reason);

  PatternSet set_;
  double room_;  ///< [m]
  Say say_;
  ExcitationPlanner excitation_;
  ExecutionTracker tracker_;
  std::map<int64_t, size_t> under_way_;  ///< handed over, not yet judged: pattern by execution id
  std::optional<Pose2> T_map_home_;
  std::optional<int64_t> standing_since_;  ///< [us] with an empty program
  int without_gain_ = 0;                   ///< patterns handed over since one was needed
  bool left_room_ = false;
  State state_ = State::kRunning;
  std::string reason_;
};

}  // namespace tread::pattern_recorder
