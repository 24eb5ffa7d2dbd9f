// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/goal_watch.hpp"

#include <algorithm>

namespace tread::planner {

bool GoalWatch::hasEnded(int64_t id) const {
  return std::find(ended_.begin(), ended_.end(), id) != ended_.end();
}

bool GoalWatch::take(const Goal& goal, int64_t now) {
  if (hasEnded(goal.id)) return false;
  if (goal_ && goal_->id == goal.id) {
    goal_ = goal;
    return true;
  }
  if (!candidate_ || candidate_->id != goal.id) candidate_given_ = now;
  candidate_ = goal;
  return true;
}

void GoalWatch::cancel() {
  end(candidate_, {});
  end(goal_, {});
}

void GoalWatch::update(int64_t now, std::optional<int64_t> armed_since, const StoodFor& stood_for) {
  if (candidate_) adopt(now, stood_for);
  if (!goal_) return;
  if (armed_since && given_ < *armed_since)
    return end(goal_,
               {StopReason::kGoalEnded, "the goal was given before the arming: give it again"});
  if (!stood_for(goal_->id))
    end(goal_,
        {StopReason::kGoalAbandoned, "the operator who gave the goal is gone: give it again"});
}

void GoalWatch::adopt(int64_t now, const StoodFor& stood_for) {
  if (stood_for(candidate_->id)) {
    end(goal_, {});
    goal_ = candidate_;
    given_ = candidate_given_;
    candidate_.reset();
  } else if (now - candidate_given_ > kWait) {
    end(candidate_, goal_ ? lost_ : Reason(StopReason::kGoalAbandoned));
  }
}

void GoalWatch::end(std::optional<Goal>& goal, const Reason& why) {
  lost_ = why;
  if (!goal) return;
  ended_.push_back(goal->id);
  if (ended_.size() > kRemembered) ended_.pop_front();
  goal.reset();
}

}  // namespace tread::planner
