// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/execution/execution_tracker.hpp"
#include "common/geometry/track.hpp"
#include "modules/planner/core/execution/motion_planner.hpp"
#include "modules/planner/core/execution/planner_inputs.hpp"
#include "modules/planner/core/map/planning_map.hpp"
#include "modules/planner/core/search/prediction.hpp"

namespace tread::planner {

/// Periods, waiting times and numbers of tries.
struct PolicyConfig {
  int64_t plan_period = 200'000;      ///< [us] between two plans while driving
  int64_t blocked_period = 500'000;   ///< [us] between two plans while standing with nothing free
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

/// The configuration of the planner.
struct PlannerConfig {
  PlanningMapConfig map;
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

/// The pattern set in use, and a newer one that waits until it fits.
class ActiveSet {
 public:
  ActiveSet(const SweepResolution& sweep, const DefaultSigma& sigma)
      : sweep_(sweep), sigma_(sigma) {}

  /// Offers a set; true if it is in use from now on.
  bool offer(const PatternSet& set, const ExecutionTracker& tracker);
  /// Tries the waiting set again; true if it is in use from now on.
  bool retry(const ExecutionTracker& tracker);
  /// Why the newest set waits; empty if none does.
  const std::string& refusal() const { return refusal_; }
  /// Null before the first set.
  const std::shared_ptr<const PatternTable>& table() const { return table_; }

 private:
  SweepResolution sweep_;
  DefaultSigma sigma_;
  std::shared_ptr<const PatternTable> table_;
  std::shared_ptr<const PatternTable> waiting_;
  std::string refusal_;
};

/// The plan that is followed, from the end of the running pattern on.
struct CurrentPlan {
  std::vector<PlanStep> steps;
  SearchEnd end = SearchEnd::kNothing;
  double time_to_go = 0.0;             ///< [s]; NaN unknown
  int expansions = 0;                  ///< of the last search
  std::optional<int64_t> made;         ///< [us] when it was searched for; nothing = search again
  std::optional<Prediction> based_on;  ///< of the running pattern when it was made

  bool due(int64_t now, int64_t period) const { return !made || now - *made >= period; }
  /// Makes a search due.
  void expire() {
    made.reset();
    based_on.reset();
  }
};

/// What the planner reports about itself.
class StatusLine {
 public:
  void say(PlanStatus status, const std::string& reason) {
    changed = changed || status != status_;
    status_ = status;
    reason_ = reason;
  }
  /// Takes precedence over other reasons while driving, until a time [us].
  void note(const std::string& text, int64_t until) { note_ = Note{text, until}; }
  void clearNote() { note_.reset(); }
  void sayDriving(int64_t now, const std::string& reason) {
    say(PlanStatus::kDriving, note_ && now < note_->until ? note_->text : reason);
  }
  PlanStatus status() const { return status_; }
  const std::string& reason() const { return reason_; }

  bool changed = false;  ///< in this step: a new plan, or another status

 private:
  struct Note {
    std::string text;
    int64_t until;  ///< [us]
  };
  PlanStatus status_ = PlanStatus::kIdle;
  std::string reason_;
  std::optional<Note> note_;
};

/// Whether the pattern of a slot ends at rest.
bool leadsToRest(const ProgramSlot& slot, const PatternTable& table);

enum class DrivingMode { kStanding, kDriving, kSettling };

/// What the supervisor and its two controllers share.
struct DrivingState {
  DrivingState(const PlannerConfig& planner_config, int64_t run_id)
      : config(planner_config),
        map(planner_config.map),
        set(planner_config.sweep, planner_config.default_sigma),
        planner(planner_config.search, planner_config.side_hysteresis),
        tracker(run_id) {}

  const PatternTable& table() const { return *set.table(); }
  /// The running pattern with its newest prediction; nullptr if it is not in the set.
  const TablePattern* runningPattern() const;
  /// Plans from `start`, and notes what came of it.
  SearchResult search(int64_t now, const PlanStep& start, int expansions);
  /// Says so if the goal is unreachable on the known map.
  bool sayUnreachable();
  void sayDriving(int64_t now);
  /// Empties the program.
  void halt(int64_t now, const std::string& why);
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
};

}  // namespace tread::planner
