// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/standing_control.hpp"

namespace tread::planner {
namespace {

/// After so many patterns in a row a recovery has helped.
constexpr int kRecovered = 6;

}  // namespace

void StandingControl::noteJoined() {
  if (++joined_ >= kRecovered) recovery_.restart();
}

void StandingControl::stand(const PlannerInputs& s, const Preconditions& ready,
                            ProgressMonitor& progress) {
  if (ready.level != Preconditions::Level::kGo) {
    blocked_since_.reset();
    return state_.status.say(ready.status, ready.reason);
  }
  if (!arrived_ && isWithin(*s.goal, s.pose->T_map_body)) {
    arrived_ = true;
    ++state_.counters["arrived"];
  }
  if (arrived_) return state_.status.say(PlanStatus::kArrived, "");
  // The map may change: it goes on as soon as there is a way.
  if (!state_.local_map.goalSubstitutionReason().empty() &&
      isWithin(state_.local_map.target(), s.pose->T_map_body)) {
    progress.restart(s.now);
    return state_.status.say(PlanStatus::kUnreachable, state_.local_map.goalSubstitutionReason());
  }
  const int64_t period =
      blocked_since_ ? state_.config.policy.blocked_period : state_.config.policy.plan_period;
  if (state_.plan.due(s.now, period)) planStart(s);
}

void StandingControl::planStart(const PlannerInputs& s) {
  if (state_.sayUnreachable()) {
    state_.plan.made = s.now;
    return;
  }
  state_.plan.steps.clear();
  PlanStep here;
  here.T_map_end = s.pose->T_map_body;
  here.exit_class = state_.table().restClass();
  const SearchResult result = state_.search(s.now, here, state_.config.policy.standing_expansions);
  if (result.steps.empty()) return noPlan(s, result.reason);
  blocked_since_.reset();
  begin(s, result.steps);
  state_.sayDriving(s.now);
}

void StandingControl::begin(const PlannerInputs& s, const std::vector<PlanStep>& steps) {
  state_.tracker.begin(state_.table().set(), steps.front().pattern_id, s.now);
  state_.plan.steps.assign(steps.begin() + 1, steps.end());
  state_.planner.side().begun(steps.front().pattern_id);
  state_.planner.side().take(state_.plan.steps, state_.table());
  if (!state_.plan.steps.empty())
    state_.tracker.setNext(state_.table().set(), state_.plan.steps.front().pattern_id);
  state_.mode = DrivingMode::kDriving;
  state_.plan.based_on.reset();
  state_.prediction = moving_.predictRunning(s);
  if (state_.plan.steps.empty()) moving_.stopNext(*state_.prediction);
}

void StandingControl::noPlan(const PlannerInputs& s, const std::string& why) {
  blocked_since_ = blocked_since_.value_or(s.now);
  state_.status.say(PlanStatus::kBlocked, why);
  if (s.now - *blocked_since_ < state_.config.policy.recovery_wait) return;
  if (recovery_.tries() < state_.config.policy.recoveries) return tryRecovery(s);
  if (static_cast<int>(state_.local_map.detours()) >= state_.config.policy.detours) return;
  state_.local_map.addDetourAhead(s.pose->T_map_body.position(), state_.config.policy.detours);
  recovery_.restart();
}

void StandingControl::tryRecovery(const PlannerInputs& s) {
  const std::vector<int> ids =
      recovery_.propose(state_.table(), state_.local_map.collisionChecker(), s.pose->T_map_body);
  if (ids.empty()) return state_.status.say(PlanStatus::kBlocked, "boxed in: no move is free");
  ++state_.counters["recovery moves"];
  joined_ = 0;
  std::vector<PlanStep> steps;
  PlanStep last;
  last.T_map_end = s.pose->T_map_body;
  for (const int id : ids) {
    last = stepAfter(last, *state_.table().find(id));
    steps.push_back(last);
  }
  blocked_since_.reset();
  begin(s, steps);
  state_.status.say(PlanStatus::kBlocked, "trying to get out");
}

}  // namespace tread::planner
