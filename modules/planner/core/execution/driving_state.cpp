// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/driving_state.hpp"

#include <cmath>
#include <utility>

namespace tread::planner {
namespace {

/// Why the running or the next pattern ends at rest, in words; empty if neither does.
std::string stopAhead(const ProgramSlot& running, const CurrentPlan& plan,
                      const PatternTable& table) {
  size_t after = 0;  // index in the plan of what begins when the vehicle stands
  if (!leadsToRest(running, table)) {
    if (plan.steps.empty() || plan.steps.front().exit_class != table.restClass()) return {};
    after = 1;
  }
  if (after >= plan.steps.size())
    return plan.end == SearchEnd::kGoal ? "stopping at the goal" : "stopping: the plan ends there";
  const TablePattern& next = *table.find(plan.steps[after].pattern_id);
  if (next.reverses) return "stopping to back up";
  const Pose2& end = next.end().pose;
  if (std::abs(end.yaw) > std::hypot(end.x, end.y)) return "stopping to turn on the spot";
  return next.exit == table.restClass() ? "stopping for a small step" : "stopping to set off anew";
}

}  // namespace

bool leadsToRest(const ProgramSlot& slot, const PatternTable& table) {
  return slot.pattern().exit_class == table.motionClass(table.restClass()).name;
}

bool ActiveSet::offer(const PatternSet& set, const ExecutionTracker& tracker) {
  waiting_ = std::make_shared<const PatternTable>(set, sweep_, sigma_);
  return retry(tracker);
}

bool ActiveSet::retry(const ExecutionTracker& tracker) {
  if (!waiting_) return false;
  refusal_ = tracker.conflictWith(waiting_->set());
  // Such a set would stop the vehicle, and nobody could tell why.
  const std::string defect = waiting_->defect();
  if (refusal_.empty() && !tracker.running().empty() && !defect.empty())
    refusal_ =
        "PATTERN_SET version " + std::to_string(waiting_->set().version()) + " waits: " + defect;
  if (!refusal_.empty()) return false;
  table_ = std::move(waiting_);
  waiting_.reset();
  return true;
}

const TablePattern* DrivingState::runningPattern() const {
  if (tracker.running().empty()) return nullptr;  // whose id 0 a set may have
  const TablePattern* newest = table().find(tracker.running().pattern_id);
  // The learner bends trajectories, never commands: another length is another pattern.
  const bool same = newest != nullptr &&
                    newest->pattern->commands.size() == tracker.running().pattern().commands.size();
  return same ? newest : nullptr;
}

SearchResult DrivingState::search(int64_t now, const PlanStep& start, int expansions) {
  const bool may_keep_next = runningPattern() != nullptr;
  SearchResult result =
      planner.plan({set.table(), map, start, plan.steps, may_keep_next}, expansions, counters);
  plan.made = now;
  status.changed = true;
  plan.expansions = result.expansions;
  plan.end = result.end;
  plan.time_to_go = result.end == SearchEnd::kNothing ? std::numeric_limits<double>::quiet_NaN()
                                                      : result.time_to_go;
  return result;
}

bool DrivingState::sayUnreachable() {
  if (!map.distanceToGoal().unreachable()) return false;
  plan.time_to_go = std::numeric_limits<double>::quiet_NaN();
  status.say(PlanStatus::kUnreachable, map.distanceToGoal().problem());
  return true;
}

void DrivingState::sayDriving(int64_t now) {
  const std::string& reason = map.goalSubstitutionReason();
  status.sayDriving(now, reason.empty() ? stopAhead(tracker.running(), plan, table()) : reason);
}

void DrivingState::halt(int64_t now, const std::string& why) {
  tracker.stop();
  settle(now);
  status.changed = true;
  ++counters["stopped at once"];
  status.say(PlanStatus::kBlocked, "stopped at once: " + why);
}

}  // namespace tread::planner
