// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/execution/execution_tracker.hpp"
#include "common/geometry/track.hpp"
#include "common/vehicle/robot_description.hpp"
#include "lcmtypes/enums.hpp"
#include "modules/planner/core/execution/motion_planner.hpp"
#include "modules/planner/core/map/collision_checker.hpp"
#include "modules/planner/core/map/distance_to_goal.hpp"
#include "modules/planner/core/search/pattern_search.hpp"
#include "modules/planner/core/search/pattern_table.hpp"

namespace tread::planner {

/// Everything the planner knows at one instant, except map and patterns.
struct PlannerInputs : RobotReadings {
  std::optional<Goal> goal;
  Reason goal_lost;          ///< why the last goal has ended; none if its operator cancelled it
  Reason bar;                ///< why the robot may not drive until a person has checked it
  int64_t set_received = 0;  ///< [us] when the last part of a pattern set arrived; 0 = never
  Reason map_fault;          ///< why mapping distrusts a range finder; none if it does not
};

/// The planner's intentions, for viewers.
struct PlanReport {
  PlanStatus status = PlanStatus::kIdle;
  Reason reason;
  int64_t utime = 0;  ///< [us] of the pose it is based on
  int64_t goal_id = 0;
  int64_t set_version = 0;
  double time_to_go = 0.0;  ///< [s]; NaN unknown
  PlanRisk risk;            ///< of the steps that have not started
  int expansions = 0;
  std::vector<int64_t> execution_ids;  ///< as many as steps; 0 = not handed over yet
  std::vector<PlanStep> steps;
};

/// The limits of the inputs' ages [us].
struct AgeLimits {
  int64_t pose = 150'000;      ///< older: the program is emptied
  int64_t bridge = 500'000;    ///< older: the same
  int64_t map_slow = 450'000;  ///< older: no new patterns except one that stops
  int64_t map_stop = 500'000;  ///< older: the program is emptied
  /// Older: the learner is lost, no new patterns except one that stops
  int64_t pattern_set = 5'000'000;
};

/// Whether the inputs permit driving.
struct Preconditions {
  enum class Level {
    kGo,
    kFinish,  ///< no new pattern except one that stops
    kStop     ///< the program is emptied now
  };
  Level level = Level::kGo;
  PlanStatus status = PlanStatus::kDriving;  ///< to report if not kGo
  Reason reason;                             ///< none if kGo
};

/// State of map and patterns, in addition to the inputs.
struct MapAndSet {
  int64_t map_utime = 0;                          ///< [us] of the newest scan in the map; 0 = none
  std::string set_defect = "no PATTERN_SET yet";  ///< why the set is unusable; empty = good
  bool was_armed = false;                         ///< the bridge has been armed since the start
};

/// Evaluates the inputs: the most severe problem decides.
Preconditions checkPreconditions(const PlannerInputs& inputs, const MapAndSet& supplies,
                                 const AgeLimits& limits, OperatorLost lost = OperatorLost::kStop);

/// A pose expected at a time from now on.
struct ExpectedPose {
  Pose2 T_map_body;
  double time = 0.0;  ///< [s] from the measurement that it is based on
};

/// The rest of a pattern, predicted from the newest measured pose.
struct Prediction {
  std::vector<ExpectedPose> ahead;  ///< remaining poses, the end last
  Pose2 T_map_end;
  double time_left = 0.0;   ///< [s] from the measurement to the end
  Uncertainty uncertainty;  ///< of the end, in map axes
};

/// Whether a pattern's end has moved away from where the plan after it expects it.
/** The end is now expected more than three standard deviations from the place expected then, and
 * more than 10 cm or .1 rad: smaller differences do not justify a new plan. */
bool leftCorridor(const Prediction& then, const Prediction& now);

/// Ratio of measured to expected motion of a running pattern so far, each about 1.
struct MotionRatio {
  double way = 1.0;
  double turn = 1.0;
};

/// Compares the motion since the start of a running pattern with the expected one up to `time` [s].
/** Little motion is uninformative: the ratios are drawn towards 1 with a weight of as much motion
 * as INS noise and a short disturbance may cause. Within 0.6 and 1.6. */
MotionRatio motionRatio(const Pose2& T_start_now, double time, const TablePattern& pattern,
                        double period);

/// The rest of a pattern that had been running for `time` [s] when the vehicle was measured at a
/// pose.
/** The rest is scaled by the motion ratio: ground that has turned the vehicle more than expected
 * will continue to do so. With a negative time the pattern starts that much later; until then the
 * vehicle keeps the twist of its entry class. */
Prediction predict(const Pose2& T_map_body, double time, const TablePattern& pattern,
                   const PatternTable& table, const MotionRatio& so_far = {});

/// Time until the first of the poses that is not free at a margin level [s]; nullopt if all are
/// free.
std::optional<double> firstConflict(const CollisionChecker& collision_checker,
                                    const std::vector<ExpectedPose>& poses, int level);

/// Periods, waiting times and numbers of tries.
struct PolicyConfig {
  int64_t plan_period = 200'000;     ///< [us] between plans while driving
  int64_t blocked_period = 500'000;  ///< [us] between plans while standing without a free pattern
  int64_t freeze = 130'000;  ///< [us] before its start, in which the next pattern is not replaced
  int64_t stop_lead = 700'000;        ///< [us] before a collision, at which the vehicle is stopped
  double coast_time = 0.3;            ///< [s] at its speed that the vehicle coasts after a stop
  int64_t settle_limit = 3'000'000;   ///< [us] after which a stopped vehicle counts as standing
  int64_t patience = 25'000'000;      ///< [us] without progress until a path is given up
  int64_t recovery_wait = 1'500'000;  ///< [us] without a free pattern until a recovery is tried
  int recoveries = 4;                 ///< attempts until the goal counts as blocked
  int detours = 6;                    ///< paths given up until it counts as blocked
  int driving_expansions = 2000;      ///< per plan
  int standing_expansions = 15000;    ///< per plan
};

/// The configuration of the planner.
struct PlannerConfig {
  PlanningMapConfig map;
  SearchConfig search;
  PolicyConfig policy;
  SideHysteresisConfig side_hysteresis;
  AgeLimits ages;
  SweepResolution sweep;
  DefaultSigma default_sigma;       ///< end errors of a pattern of unknown covariance
  std::optional<double> max_slope;  ///< [rad] of the ground that plans may use
  OperatorRules operators;          ///< lease 0: a log older than leases
  int64_t lease = 200'000;          ///< [us] without a newer program, after which the motors stop
  int64_t deadline = 30'000;        ///< [us] limit of a search on the robot
  std::string store;                ///< folder for data kept across restarts; empty = none
  std::string effective;            ///< the whole as YAML, for CONFIG
};

/// The learner's estimate of the available deceleration.
struct GripKnowledge {
  double deceleration = kNoLimit;  ///< [m/s2]
  bool gave_way = false;           ///< the ground gave less than requested
  int signs = kSure;               ///< executions with evidence since the learner started

  static constexpr int kSure = 6;  ///< fewer are few
  /// [s] in which the vehicle must be able to stop. A vehicle that slides cannot steer; an estimate
  /// from few executions may be too high.
  double stopWithin() const { return gave_way ? 0.8 : signs > 0 && signs < kSure ? 1.0 : 1.2; }
  /// [s] at its speed that a vehicle slides on, where the ground gave way.
  double slidingTime(double speed) const { return gave_way ? speed / (2.0 * deceleration) : 0.0; }
};

/// The pattern set in use, and a newer one that waits until it fits.
class ActiveSet {
 public:
  ActiveSet(const SweepResolution& sweep, const DefaultSigma& sigma, double top_speed = kNoLimit)
      : sweep_(sweep), sigma_(sigma), top_speed_(top_speed) {}

  /// Offers a set; true if it is now in use.
  bool offer(const PatternSet& set, const ExecutionTracker& tracker);
  /// Tries the waiting set again; true if it is now in use.
  bool retry(const ExecutionTracker& tracker);
  /// From now on starts only patterns up to this speed [m/s], but always those of the slowest
  /// classes that drive forwards and backwards. True if another table is in use or waits.
  bool limitSpeed(double speed);
  /// Why the newest set waits; empty if none does.
  const std::string& refusal() const { return refusal_; }
  /// Null before the first set.
  const std::shared_ptr<const PatternTable>& table() const { return table_; }

 private:
  SweepResolution sweep_;
  DefaultSigma sigma_;
  double topSpeedOf(const PatternSet& set) const;

  double top_speed_;         ///< [m/s] of the patterns used from a set
  double limit_ = kNoLimit;  ///< [m/s] set by limitSpeed()
  std::shared_ptr<const PatternTable> table_;
  std::shared_ptr<const PatternTable> waiting_;
  std::string refusal_;
};

/// [s] for a PROGRAM, its transport to the motors, and the next measurement.
inline constexpr double kReactionDelay = 0.2;

/// The plan being followed, from the end of the running pattern on.
struct CurrentPlan {
  std::vector<PlanStep> steps;
  SearchEnd end = SearchEnd::kNothing;
  double time_to_go = 0.0;             ///< [s]; NaN unknown
  PlanRisk risk;                       ///< of the steps when it was made
  int expansions = 0;                  ///< of the last search
  std::optional<int64_t> made;         ///< [us] of the search; nullopt = search again
  std::optional<Prediction> based_on;  ///< prediction of the running pattern at that time

  bool due(int64_t now, int64_t period) const { return !made || now - *made >= period; }
  /// Makes a new search due.
  void expire() {
    made.reset();
    based_on.reset();
  }
};

/// What the planner reports about itself.
class StatusLine {
 public:
  void say(PlanStatus status, const Reason& reason) {
    changed = changed || status != status_;
    status_ = status;
    reason_ = reason;
  }
  /// Overrides other reasons while driving, until a time [us].
  void note(const Reason& reason, int64_t until) { note_ = Note{reason, until}; }
  void clearNote() { note_.reset(); }
  void sayDriving(int64_t now, const Reason& reason) {
    say(PlanStatus::kDriving, note_ && now < note_->until ? note_->reason : reason);
  }
  PlanStatus status() const { return status_; }
  const Reason& reason() const { return reason_; }

  bool changed = false;  ///< in this step: a new plan, or another status

 private:
  struct Note {
    Reason reason;
    int64_t until;  ///< [us]
  };
  PlanStatus status_ = PlanStatus::kIdle;
  Reason reason_;
  std::optional<Note> note_;
};

/// Whether the pattern of a slot ends at rest.
bool leadsToRest(const PlannedExecution& slot, const PatternTable& table);

enum class DrivingMode { kStanding, kDriving, kSettling };

/// State shared by the supervisor and its two controllers.
struct DrivingState {
  DrivingState(const PlannerConfig& planner_config, int64_t run_id)
      : config(planner_config),
        map(planner_config.map),
        set(planner_config.sweep, planner_config.default_sigma, planner_config.search.top_speed),
        planner(planner_config.search, planner_config.side_hysteresis),
        tracker(run_id) {}

  const PatternTable& table() const { return *set.table(); }
  /// The running pattern with its newest prediction; nullptr if it is not in the set.
  const TablePattern* runningPattern() const;
  /// Plans from `start`, and notes the result.
  PlannedWay search(int64_t now, const PlanStep& start, int expansions);
  /// [s] that a vehicle continues at its twist after a stop.
  double coastTime(const Twist2& twist) const;
  /// The ground's costs for the set in use; nullptr if shock costs nothing.
  const GroundCost* groundCost();
  /// Reports it if the goal is unreachable on the known map.
  bool sayUnreachable();
  void sayDriving(int64_t now);
  /// Empties the program.
  void halt(int64_t now, const Reason& why);
  void settle(int64_t now) {
    mode = DrivingMode::kSettling;
    settling_since = now;
    plan.steps.clear();
  }

  PlannerConfig config;
  PlanningMap map;
  ActiveSet set;
  MotionPlanner planner;
  ExecutionTracker tracker;
  PoseTrack track{5'000'000};  ///< [us]
  CurrentPlan plan;
  std::optional<Prediction> prediction;  ///< of the running pattern in this step
  StatusLine status;
  std::map<std::string, int64_t> counters;  ///< of events, by their name in words
  DrivingMode mode = DrivingMode::kSettling;
  int64_t settling_since = 0;  ///< [us]
  ShockKnowledge shock;        ///< newest
  /// Of `shock` and ground_table; recomputed when either changes
  std::optional<GroundCost> ground;
  std::shared_ptr<const PatternTable> ground_table;
  GripKnowledge grip;
  bool steep = false;  ///< it may slide where it stands: no time to lose
};

}  // namespace tread::planner
