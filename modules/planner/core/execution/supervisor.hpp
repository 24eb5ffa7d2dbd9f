// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/execution/execution_tracker.hpp"
#include "common/geometry/track.hpp"
#include "modules/planner/core/execution/motion_monitors.hpp"
#include "modules/planner/core/execution/planner_inputs.hpp"
#include "modules/planner/core/execution/recovery.hpp"
#include "modules/planner/core/execution/side_hysteresis.hpp"
#include "modules/planner/core/map/local_map.hpp"
#include "modules/planner/core/search/pattern_search.hpp"
#include "modules/planner/core/search/prediction.hpp"

namespace tread::planner {

/// When what is done.
struct PolicyConfig {
  int64_t plan_period = 200'000;      ///< [us] between two plans while driving
  int64_t blocked_period = 500'000;   ///< [us] between two looks while standing with nothing free
  int64_t freeze = 130'000;           ///< [us] before its start the next pattern is not replaced
  int64_t stop_lead = 700'000;        ///< [us] before a collision the vehicle is stopped
  double coast_time = 0.3;            ///< [s] at its speed the vehicle coasts on after a stop
  int64_t settle_limit = 3'000'000;   ///< [us] after which a stopped vehicle counts as standing
  int64_t patience = 25'000'000;      ///< [us] without progress until a way is given up
  int64_t recovery_wait = 1'500'000;  ///< [us] with nothing free until a recovery is tried
  int recoveries = 4;                 ///< tries until the goal counts as blocked
  int detours = 6;                    ///< ways given up until it counts as blocked
  int driving_expansions = 2000;      ///< per plan
  int standing_expansions = 15000;    ///< per plan
};

/// All that the planner can be told about its behaviour.
struct PlannerConfig {
  LocalMapConfig local_map;
  SearchConfig search;
  PolicyConfig policy;
  SideHysteresisConfig side_hysteresis;
  AgeLimits ages;
  SweepResolution sweep;
  DefaultSigma default_sigma;  ///< errors at the end of a pattern of unknown covariance
  int64_t lease = 200'000;     ///< [us] the motors stop when nothing newer came for this long
  int64_t deadline = 30'000;   ///< [us] after which a search is cut off on the robot
  std::string effective;       ///< the whole as YAML, for CONFIG
};

/// What a step decided beside the program.
struct Decision {
  bool planned = false;  ///< a new plan was made, or something changed that viewers want to know
  PlanReport report;
};

/// The planner without its wires: what to hand over to the motor bridge, from all that is known.
/** Call takeSet() and localMap().put() as things come, then step() at 20 Hz. It
    1. learns from MOTOR and EXECUTION what became of what it handed over;
    2. judges the inputs, and empties the program or lets the vehicle come to rest;
    3. checks what is under way against the newest map: a running pattern that will hit something is
   stopped in time, a next one is replaced;
    4. plans from where the running pattern is expected to end, and hands over the next one; with no
   plan the next one is the one that stops;
    5. standing, plans from where it stands; with no plan waits, tries to get out, and says that it
   is blocked. */
class Supervisor {
 public:
  Supervisor(const PlannerConfig& config, int64_t run_id);

  /// From the next step on plans are made with this set; what is handed over keeps its version.
  /** A set with other commands for what runs or comes next, or one that cannot be driven with while
   * something runs, is refused: false, and setRefusal() says why. It waits, and is taken in the
   * first step in which it fits, which may be when the vehicle stands. */
  bool takeSet(const PatternSet& set);
  const std::string& setRefusal() const { return set_refusal_; }
  LocalMap& localMap() { return local_map_; }
  const DistanceToGoal& distanceToGoal() const { return local_map_.distanceToGoal(); }

  /// `stop` may end a search early (a deadline); the configured expansions end it in any case.
  Decision step(const PlannerInputs& inputs, const StopPredicate& stop);

  const ExecutionTracker& program() const { return tracker_; }
  const PatternSearch& search() const { return search_; }
  /// How often something noteworthy happened, by its name in words.
  const std::map<std::string, int64_t>& counters() const { return counters_; }

 private:
  enum class Mode { kStanding, kDriving, kSettling };
  static constexpr int64_t kTrackSpan = 5'000'000;  ///< [us]

  void followBridge(const PlannerInputs& s);
  bool takeWaitingSet();
  void followSet();
  void noteGoal(const PlannerInputs& s);
  void act(const PlannerInputs& s, const Preconditions& ready);
  void settle(const PlannerInputs& s);
  void halt(const PlannerInputs& s, const std::string& why);
  // Driving.
  void drive(const PlannerInputs& s, const Preconditions& ready);
  Prediction predictRunning(const PlannerInputs& s) const;
  void watchCorridor();
  bool frozen(const PlannerInputs& s) const;
  bool nextCollides(const Prediction& running) const;
  void planNext(const PlannerInputs& s, const Preconditions& ready, const Prediction& running);
  PlanStep endOf(const Prediction& running) const;
  void searchNext(const PlannerInputs& s, const Prediction& running);
  bool stopNext(const Prediction& running);
  void keepClear(const PlannerInputs& s, const Prediction& running);
  bool stoppingIsBetter(const PlannerInputs& s, const std::vector<ExpectedPose>& poses) const;
  std::vector<ExpectedPose> posesAfter(const Prediction& running) const;
  std::optional<double> conflict(const Pose2& here, const std::vector<ExpectedPose>& poses) const;
  // Standing.
  void stand(const PlannerInputs& s, const Preconditions& ready);
  void planStart(const PlannerInputs& s);
  void begin(const PlannerInputs& s, const std::vector<PlanStep>& steps);
  void noPlan(const PlannerInputs& s, const std::string& why);
  void tryRecovery(const PlannerInputs& s);
  // Both.
  SearchResult searchFrom(const PlannerInputs& s, const PlanStep& start, int expansions);
  SearchResult keepSide(SearchProblem& problem, SearchResult fresh, const StopPredicate& stop);
  SearchResult keepNext(SearchProblem& problem, SearchResult fresh, const StopPredicate& stop);
  bool sayUnreachable();
  void watchProgress(const PlannerInputs& s);
  void addDetour(const PlannerInputs& s);
  void sayDriving(const PlannerInputs& s);
  bool leadsToRest(const ProgramSlot& slot) const;
  /// Why the running or the next pattern ends at rest, in words; empty if neither does.
  std::string stopAhead() const;
  void say(PlanStatus status, const std::string& reason);
  const TablePattern* runningPattern() const;
  PlanReport report(const PlannerInputs& s) const;

  PlannerConfig config_;
  LocalMap local_map_;
  PatternSearch search_;
  PatternSearch branch_search_;  ///< along the branch that the planner is committed to
  SideHysteresis hysteresis_;
  ExecutionTracker tracker_;
  std::shared_ptr<const PatternTable> table_;
  /// Of the last search: its tree, which is drawn later, points into it.
  std::shared_ptr<const PatternTable> searched_table_;
  std::shared_ptr<const PatternTable> waiting_table_;  ///< of a set that is refused so far
  std::string set_refusal_;
  int cycles_with_old_set_ = 0;  ///< since the newest set was taken
  PoseTrack track_{kTrackSpan};
  StandstillDetector standstill_;
  ProgressMonitor progress_;
  Recovery recovery_;
  StopPredicate stop_;

  Mode mode_ = Mode::kSettling;
  int64_t settling_since_ = 0;
  int64_t last_plan_ = 0;
  std::optional<int64_t> goal_id_;
  bool was_armed_ = false;
  bool arrived_ = false;
  int switches_ = 0;                      ///< patterns joined since the last recovery
  std::optional<int64_t> nothing_since_;  ///< standing, and nothing was free since then
  std::vector<PlanStep> plan_;            ///< from the end of the running pattern on
  std::optional<Prediction> prediction_;  ///< of the running pattern in this step
  std::optional<Prediction> planned_on_;  ///< of the running pattern when the plan was made
  SearchEnd plan_end_ = SearchEnd::kNothing;
  double time_to_go_ = 0.0;
  int expansions_ = 0;
  bool planned_ = false;
  PlanStatus status_ = PlanStatus::kIdle;
  std::string reason_;
  std::string note_;  ///< what is worth knowing although it drives
  int64_t note_until_ = 0;
  std::map<std::string, int64_t> counters_;
};

}  // namespace tread::planner
