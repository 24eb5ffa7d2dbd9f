// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <set>

#include "common/messages/pattern_messages.hpp"

#include "tools/missions/mission_runner.hpp"
#include "tools/missions/steadiness.hpp"

namespace tread::missions {

/// The true surface under the robot; a change counts after a second on the new one.
class SurfaceTracker {
 public:
  SurfaceTracker(int64_t start, const std::string& surface) : changes_{{start, surface}} {}

  /// Returns since when the robot has been on another surface, once that is confirmed.
  std::optional<int64_t> step(int64_t utime, const std::string& present);
  const std::string& surface() const { return changes_.back().second; }
  /// The surface of a time span; empty if it changed in it.
  std::string between(int64_t from, int64_t to) const;

 private:
  std::vector<std::pair<int64_t, std::string>> changes_;  ///< since when [us], confirmed
  std::string next_;                                      ///< perhaps the next surface
  int64_t next_since_ = 0;
};

/// Decides from the true world and the bus when and how a mission has ended, and records it.
class Referee {
 public:
  Referee(RobotSystem& system, const MissionWorld& world);

  /// Call every 50 ms of virtual time.
  void step();
  bool ended() const { return ended_; }
  MissionResult result() const;
  void fillScene(MissionScene& scene) const {
    scene.map = map_;
    scene.tree = tree_;
  }

 private:
  void listen(Bus& bus);
  void hear(const plan_t& message);
  void hear(const execution_t& message);
  void hear(const pattern_set_part_t& part);
  void hear(const learning_t& message);
  void hear(const plan_tree_t& message);
  void hear(const map_tile_t& message);
  bool isFree(const Pose2& T_map_start, const std::vector<const MotionPattern*>& patterns) const;
  void noteContacts();
  std::string presentPattern() const;
  void noteSurface();
  void noteMotion();
  void judge();
  void end(MissionOutcome outcome, const std::string& reason);
  double seconds(int64_t utime) const { return static_cast<double>(utime - start_) * 1e-6; }
  double toGo() const;

  RobotSystem& system_;
  const MissionWorld& world_;
  int64_t start_;
  MissionResult result_;
  bool ended_ = false;
  plan_t plan_{};
  motor_t motor_{};
  std::set<int64_t> versions_;  ///< of pattern sets that were published
  PatternSetAssembler sets_;
  FlipDetector flips_;
  StopDetector stops_;
  std::string abort_reason_;  ///< of the newest execution, if it was aborted
  std::map<int, std::string> pattern_names_;
  std::map<std::pair<int64_t, int64_t>, execution_record_t> records_;  ///< by run and execution id
  SurfaceTracker surfaces_;
  std::optional<int64_t> refused_since_;
  Pose2 last_pose_;
  int64_t moved_at_;  ///< when and where it last was 10 cm or 0.1 rad from where it is
  Pose2 moved_from_;
  TileMap map_;
  std::vector<report::TreeEdge> tree_;
};

}  // namespace tread::missions
