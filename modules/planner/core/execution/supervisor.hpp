// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <optional>
#include <string>

#include "modules/planner/core/execution/slope_guard.hpp"
#include "modules/planner/core/execution/standing_control.hpp"

namespace tread::planner {

/// Result of a step beside the program.
struct Decision {
  bool planned = false;  ///< a new plan was made, or something that viewers show has changed
  Reason halted;         ///< why the preconditions stopped it in this step; none = they did not
  PlanReport report;
};

/// The planner's core: decides what to hand over to the motor bridge, from all inputs.
/** Call takeSet() and map().put() as messages arrive, then step() at 20 Hz. It
 *   1. follows the handed-over patterns by MOTOR and EXECUTION;
 *   2. checks the preconditions, and empties the program or lets the vehicle come to rest;
 *   3. checks the handed-over patterns against the newest map: stops a running pattern in time
 *      before a collision, and replaces a next one;
 *   4. plans from the expected end of the running pattern, and hands over the next one, which
 *      without a plan is one that stops;
 *   5. at standstill, plans from the present pose; without a plan waits, tries recoveries, and
 *      reports that it is blocked.
 * Under manual control it keeps planning from the present pose, but hands nothing over. */
class Supervisor {
 public:
  Supervisor(const PlannerConfig& config, int64_t run_id);
  Supervisor(const Supervisor&) = delete;  // its parts refer to each other
  Supervisor& operator=(const Supervisor&) = delete;

  /// Uses this set for plans from the next step on; handed-over patterns keep their version.
  /** A set with other commands for the running or the next pattern, or an unusable one while a
   * pattern runs, is refused: returns false, and setRefusal() gives the reason. It waits, and is
   * used from the first step in which it fits, possibly at standstill. */
  bool takeSet(const PatternSet& set);
  const std::string& setRefusal() const { return state_.set.refusal(); }
  PlanningMap& map() { return state_.map; }
  /// [s] at its speed that the vehicle continues after a zero command, learned from its stops.
  void setStoppingTime(double seconds);
  /// The learner's present estimate of the available deceleration.
  void setGrip(const GripKnowledge& grip);
  const GripKnowledge& grip() const { return state_.grip; }
  /// The learner's present estimate of shock.
  void setShock(const ShockKnowledge& shock) {
    state_.shock = shock;
    state_.ground.reset();
  }
  const DistanceToGoal& distanceToGoal() const { return state_.map.distanceToGoal(); }

  /// `stop` may end a search early (a deadline); the configured number of expansions ends it in any
  /// case.
  Decision step(const PlannerInputs& inputs, const StopPredicate& stop);

  const ExecutionTracker& program() const { return state_.tracker; }
  const PatternSearch& search() const { return state_.planner.search(); }
  /// How often noteworthy events happened, by name in words.
  const std::map<std::string, int64_t>& counters() const { return state_.counters; }

 private:
  void keepOffSlopes(const PlannerInputs& s);
  void followGoal(const PlannerInputs& s);
  void followBridge(const PlannerInputs& s);
  void joinedNext();
  void noteNewSet();
  void act(const PlannerInputs& s, const Preconditions& ready);
  void shadow(const PlannerInputs& s, const Preconditions& ready);
  void watchProgress(const PlannerInputs& s);
  PlanReport report(const PlannerInputs& s) const;

  DrivingState state_;
  MovingControl moving_;
  StandingControl standing_;
  StandstillDetector standstill_;
  ProgressMonitor progress_;
  SlopeGuard slopes_;
  std::optional<int64_t> goal_id_;
  Reason halted_;
  bool was_armed_ = false;
  bool by_hand_ = false;  ///< a person drives
};

}  // namespace tread::planner
