// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/supervisor.hpp"

namespace tread::planner {
void Supervisor::stand(const PlannerInputs& s, const Preconditions& ready) {
  if (ready.level != Preconditions::Level::kGo) {
    nothing_since_.reset();
    return say(ready.status, ready.reason);
  }
  if (!arrived_ && isWithin(*s.goal, s.pose->T_map_body)) {
    arrived_ = true;
    ++counters_["arrived"];
  }
  if (arrived_) return say(PlanStatus::kArrived, "");
  // The map may change: it goes on as soon as there is a way.
  if (!local_map_.goalSubstitutionReason().empty() &&
      isWithin(local_map_.target(), s.pose->T_map_body)) {
    progress_.restart(s.now);
    return say(PlanStatus::kUnreachable, local_map_.goalSubstitutionReason());
  }
  const int64_t period =
      nothing_since_ ? config_.policy.blocked_period : config_.policy.plan_period;
  if (s.now - last_plan_ >= period) planStart(s);
}

void Supervisor::planStart(const PlannerInputs& s) {
  if (sayUnreachable()) {
    last_plan_ = s.now;
    return;
  }
  plan_.clear();
  PlanStep here;
  here.T_map_end = s.pose->T_map_body;
  here.exit_class = table_->restClass();
  const SearchResult result = searchFrom(s, here, config_.policy.standing_expansions);
  if (result.steps.empty()) return noPlan(s, result.reason);
  nothing_since_.reset();
  begin(s, result.steps);
  sayDriving(s);
}

void Supervisor::begin(const PlannerInputs& s, const std::vector<PlanStep>& steps) {
  tracker_.begin(table_->set(), steps.front().pattern_id, s.now);
  plan_.assign(steps.begin() + 1, steps.end());
  hysteresis_.begun(steps.front().pattern_id);
  hysteresis_.take(plan_, *table_);
  if (!plan_.empty()) tracker_.setNext(table_->set(), plan_.front().pattern_id);
  mode_ = Mode::kDriving;
  planned_on_.reset();
  prediction_ = predictRunning(s);
  if (plan_.empty()) stopNext(*prediction_);
}

void Supervisor::noPlan(const PlannerInputs& s, const std::string& why) {
  nothing_since_ = nothing_since_.value_or(s.now);
  say(PlanStatus::kBlocked, why);
  if (s.now - *nothing_since_ < config_.policy.recovery_wait) return;
  if (recovery_.tries() < config_.policy.recoveries) return tryRecovery(s);
  if (static_cast<int>(local_map_.detours()) >= config_.policy.detours) return;
  addDetour(s);
  recovery_.restart();
}

void Supervisor::tryRecovery(const PlannerInputs& s) {
  const std::vector<int> ids =
      recovery_.propose(*table_, local_map_.collisionChecker(), s.pose->T_map_body);
  if (ids.empty()) return say(PlanStatus::kBlocked, "boxed in: no move is free");
  ++counters_["recovery moves"];
  switches_ = 0;
  std::vector<PlanStep> steps;
  PlanStep last;
  last.T_map_end = s.pose->T_map_body;
  for (const int id : ids) {
    last = stepAfter(last, *table_->find(id));
    steps.push_back(last);
  }
  nothing_since_.reset();
  begin(s, steps);
  say(PlanStatus::kBlocked, "trying to get out");
}

}  // namespace tread::planner
