// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/execution/execution_tracker.hpp"
#include "modules/pattern_recorder/core/tour.hpp"

namespace tread::pattern_recorder {

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
  /// driven, see Tour.
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
  Tour tour_;
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
