// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <optional>
#include <string>

#include "modules/planner/core/execution/slope_guard.hpp"
#include "modules/planner/core/execution/standing_control.hpp"

namespace tread::planner {

/// What a step decided beside the program.
struct Decision {
  bool planned = false;  ///< a new plan was made, or something changed that viewers want to know
  Reason halted;  ///< why it was stopped by its preconditions in this step; none = it was not
  PlanReport report;
};

/// The planner without its wires: what to hand over to the motor bridge, from all that is known.
/** Call takeSet() and map().put() as things come, then step() at 20 Hz. It
    1. learns from MOTOR and EXECUTION what became of what it handed over;
    2. checks the preconditions, and empties the program or lets the vehicle come to rest;
    3. checks what is under way against the newest map: a running pattern that will hit something is
   stopped in time, a next one is replaced;
    4. plans from where the running pattern is expected to end, and hands over the next one; with no
   plan the next one is the one that stops;
    5. standing, plans from where it stands; with no plan waits, tries to get out, and says that it
   is blocked.
   While a person drives by hand it goes on planning from where the robot is, and hands over
   nothing. */
class Supervisor {
 public:
  Supervisor(const PlannerConfig& config, int64_t run_id);
  Supervisor(const Supervisor&) = delete;  // its parts refer to each other
  Supervisor& operator=(const Supervisor&) = delete;

  /// From the next step on plans are made with this set; what is handed over keeps its version.
  /** A set with other commands for what runs or comes next, or one that cannot be driven with while
   * something runs, is refused: false, and setRefusal() says why. It waits, and is taken in the
   * first step in which it fits, which may be when the vehicle stands. */
  bool takeSet(const PatternSet& set);
  const std::string& setRefusal() const { return state_.set.refusal(); }
  PlanningMap& map() { return state_.map; }
  /// [s] at its speed that the vehicle goes on after a zero command, learned from its stops.
  void setStoppingTime(double seconds);
  /// What the ground gives, as the learner knows it by now.
  void setGrip(const GripKnowledge& grip);
  const GripKnowledge& grip() const { return state_.grip; }
  /// How hard ground shakes, as the learner knows it by now.
  void setShock(const ShockKnowledge& shock) {
    state_.shock = shock;
    state_.ground.reset();
  }
  const DistanceToGoal& distanceToGoal() const { return state_.map.distanceToGoal(); }

  /// `stop` may end a search early (a deadline); the configured expansions end it in any case.
  Decision step(const PlannerInputs& inputs, const StopPredicate& stop);

  const ExecutionTracker& program() const { return state_.tracker; }
  const PatternSearch& search() const { return state_.planner.search(); }
  /// How often something noteworthy happened, by its name in words.
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
