// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <tread/plan_t.hpp>

#include "common/geometry/se2.hpp"
#include "common/messages/pattern_messages.hpp"
#include "common/pattern/pattern.hpp"
#include "tools/lab/missions/mission_runner.hpp"

namespace tread::missions {

/// Detects flips in published plans: the robot dithers between left and right.
/** A flip is a plan that turns to the other side than the previous plan although that one was still
 * feasible.
 *  1. The comparison begins after the running pattern, where the decision is still open. Patterns
 * of the previous plan that have begun meanwhile are skipped; if a different pattern was begun, the
 * comparison begins with that one.
 *  2. The side of a plan is that of its first pattern that begins within the next 3 s and changes
 * the heading by more than 0.12 rad (7 degrees). A plan without such a pattern has no side and does
 * not replace the last one: left, straight on, right is a flip.
 *  3. The previous plan was still feasible if its patterns, placed at the newest prediction with
 * the newest set, touch no obstacle of the newest map with the planner's checking margin.
 *  So a planned bend to the left and then to the right is no flip, nor is avoiding a newly seen
 * obstacle; a change to a merely better path is one. */
class FlipDetector {
 public:
  /// Whether a sequence of patterns from a pose touches no known obstacle.
  using IsFree =
      std::function<bool(const Pose2& T_map_start, const std::vector<const MotionPattern*>&)>;

  explicit FlipDetector(IsFree is_free) : is_free_(std::move(is_free)) {}

  /// Sets the newest pattern set; without one no flip is detected.
  void take(const PatternSet& set) { set_ = set; }
  /// Processes the next plan; returns a flip (without its time) if it is one.
  std::optional<Flip> hear(const plan_t& plan);

 private:
  static constexpr double kTurn = 0.12;  ///< [rad]
  static constexpr double kAhead = 3.0;  ///< [s]
  using Patterns = std::vector<const MotionPattern*>;

  std::optional<Patterns> patternsOf(const std::vector<int32_t>& ids) const;
  /// The first turning pattern; nullptr = the plan has no side.
  const MotionPattern* turnOf(const Patterns& patterns) const;

  IsFree is_free_;
  std::optional<PatternSet> set_;
  int64_t running_ = 0;            ///< execution id
  std::vector<int32_t> intended_;  ///< patterns after the running one, of the last plan with a side
};

/// Published reasons when the robot slowed down.
struct StopReasons {
  std::string planner;  ///< PLAN: its reason
  std::string bridge;   ///< EXECUTION: why the last one was aborted, if it was
};

/// Detects each stop of the true robot after it has moved.
/** At rest: slower than 5 cm/s and 0.05 rad/s for 0.2 s, so transitions through rest (a turn on the
 * spot, reversing) count. The reason is the planner's at that moment, or the bridge's if the
 * planner published none. Standing before the first motion is not a stop. */
class StopDetector {
 public:
  /// Call every 50 ms of virtual time [us] with the true velocity.
  void step(int64_t utime, const Twist2& v_body, const StopReasons& reasons);

  /// All stops, with times in [s] since `start` [us]; a stop that still lasts is left out if
  /// `arrived`.
  std::vector<Stop> stops(int64_t start, bool arrived) const;
  /// [us] of the first motion; 0 = it never moved.
  int64_t begun() const { return begun_; }
  /// [s] in motion.
  double driven() const { return static_cast<double>(driven_) * 1e-6; }

 private:
  static constexpr int64_t kAtRestAfter = 200'000;  ///< [us]
  static constexpr double kSlow = 0.05;             ///< [m/s, rad/s]

  struct Rest {
    int64_t from = 0;
    int64_t to = 0;
    std::string reason;
  };

  std::vector<Rest> rests_;
  int64_t begun_ = 0;
  int64_t last_step_ = 0;
  int64_t driven_ = 0;
  bool slow_ = true;
  bool resting_ = false;  ///< the last of rests_ is not over
  Rest slowed_;           ///< start of the slow phase, and its reason
};

/// Tracks the true surface under the robot; a change is confirmed after 1 s on the new one.
class SurfaceTracker {
 public:
  SurfaceTracker(int64_t start, const std::string& surface) : changes_{{start, surface}} {}

  /// Returns since when the robot has been on another surface, once that is confirmed.
  std::optional<int64_t> step(int64_t utime, const std::string& present);
  const std::string& surface() const { return changes_.back().second; }
  /// Surface during a time span; empty if it changed.
  std::string between(int64_t from, int64_t to) const;

 private:
  std::vector<std::pair<int64_t, std::string>> changes_;  ///< start [us] of each confirmed surface
  std::string next_;                                      ///< candidate for the next surface
  int64_t next_since_ = 0;
};

/// Decides from the true world and the bus when and how a mission ends, and records it.
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
  void hear(const motor_t& message);
  void hear(const execution_t& message);
  void hear(const pattern_set_part_t& part);
  void hear(const learning_t& message);
  void hear(const plan_tree_t& message);
  void hear(const map_tile_t& message);
  void notePlan(const plan_t& message);
  bool isFree(const Pose2& T_map_start, const std::vector<const MotionPattern*>& patterns) const;
  void noteContacts();
  std::string presentPattern() const;
  void noteSurface();
  void noteMotion();
  void noteClearance();
  void judge();
  void judgeTimed(const TimedRun& run);
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
  std::set<int64_t> versions_;  ///< of published pattern sets
  PatternSetAssembler sets_;
  FlipDetector flips_;
  StopDetector stops_;
  std::string abort_reason_;  ///< of the newest execution, if aborted
  std::map<std::pair<int64_t, int64_t>, execution_record_t> records_;  ///< by run and execution id
  SurfaceTracker surfaces_;
  std::optional<int64_t> refused_since_;
  std::optional<int64_t> clock_start_;  ///< [us] of a timed run
  Pose2 last_pose_;
  int64_t moved_at_;  ///< last time and pose before a motion of 10 cm or 0.1 rad
  Pose2 moved_from_;
  TileMap map_;
  std::vector<report::TreeEdge> tree_;
};

}  // namespace tread::missions
