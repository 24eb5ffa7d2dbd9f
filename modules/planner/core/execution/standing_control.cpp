// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/standing_control.hpp"

#include <algorithm>
#include <cmath>

namespace tread::planner {
namespace {

struct Move {
  std::vector<const TablePattern*> patterns;
  Pose2 end;  // relative to the start
};

/// Moves of one or two patterns from rest to rest.
std::vector<Move> movesFromRest(const PatternTable& table) {
  std::vector<Move> moves;
  for (const TablePattern* first : table.from(table.restClass())) {
    if (first->exit == table.restClass()) {
      moves.push_back({{first}, first->end().pose});
      continue;
    }
    for (const TablePattern* second : table.stopsFrom(first->exit))
      moves.push_back({{first, second}, first->end().pose * second->end().pose});
  }
  return moves;
}

/// Preference of a move in this attempt; the largest is taken.
double worth(const Move& move, int number) {
  switch (number % 3) {
    case 0:
      return -move.end.x - 0.1 * std::abs(move.end.yaw);
    case 1:
      return move.end.yaw - std::hypot(move.end.x, move.end.y);
    default:
      return -move.end.yaw - std::hypot(move.end.x, move.end.y);
  }
}

/// Whether a move is free; with `regains`, only if the margin increases along it.
bool isFree(const Move& move, const CollisionChecker& around, const Pose2& start, bool regains) {
  int level = around.freeLevel(start, CollisionChecker::kPlan);
  Overlap overlap = around.overlap(start);
  Pose2 pose = start;
  for (const TablePattern* pattern : move.patterns) {
    if (level >= 0) {
      const int wanted = regains ? CollisionChecker::kPlan : level;
      if (!around.sweepRegains(turned(pose), level, *pattern, wanted)) return false;
      level = around.freeLevel(pose * pattern->end().pose, wanted);
    } else {
      const std::optional<Overlap> after = around.escape(pose, overlap, *pattern);
      if (!after) return false;
      overlap = *after;
    }
    pose = pose * pattern->end().pose;
  }
  return true;
}

/// Patterns in a row after which a recovery has succeeded.
constexpr int kRecovered = 6;

}  // namespace

void StandstillDetector::take(const PoseReading& pose) {
  if (!poses_.empty() && pose.utime <= poses_.back().utime) return;
  poses_.push_back(pose);
  while (poses_.size() > 2 && poses_[1].utime <= pose.utime - kMoment) poses_.pop_front();
}

bool StandstillDetector::stands(int64_t since) const {
  if (poses_.empty() || poses_.front().utime < since ||
      poses_.back().utime - poses_.front().utime < kMoment)
    return false;
  if (poses_.back().twist) {
    return std::all_of(poses_.begin(), poses_.end(), [](const PoseReading& pose) {
      return pose.twist && std::hypot(pose.twist->v_x, pose.twist->v_y) < kSlow &&
             std::abs(pose.twist->omega) < kSlow;
    });
  }
  const Pose2 moved = between(poses_.front().T_map_body, poses_.back().T_map_body);
  const double seconds = static_cast<double>(kMoment) * 1e-6;
  return std::hypot(moved.x, moved.y) < kSlow * seconds &&
         std::abs(wrapAngle(moved.yaw)) < kSlow * seconds;
}

void ProgressMonitor::restart(int64_t now) {
  since_ = now;
  any_ = false;
  dead_ends_ = 0;
}

bool ProgressMonitor::stuck(double distance_to_go, int64_t now) {
  const bool nearer = !any_ || distance_to_go < best_ - kProgress;
  const bool dead_end = any_ && distance_to_go > best_ + kDeadEnd && dead_ends_ < kDeadEnds;
  if (dead_end) ++dead_ends_;
  if (nearer || dead_end) {
    best_ = distance_to_go;
    any_ = true;
    since_ = now;
    return false;
  }
  if (now - since_ < patience_) return false;
  since_ = now;
  best_ = distance_to_go;
  return true;
}

std::vector<int> Recovery::propose(const PatternTable& table,
                                   const CollisionChecker& collision_checker,
                                   const Pose2& T_map_body) {
  std::vector<Move> moves = movesFromRest(table);
  const int number = tries_++;
  std::stable_sort(moves.begin(), moves.end(), [number](const Move& a, const Move& b) {
    return worth(a, number) > worth(b, number);
  });
  for (const bool regains : {true, false}) {
    for (const Move& move : moves) {
      if (!isFree(move, collision_checker, T_map_body, regains)) continue;
      std::vector<int> ids;
      for (const TablePattern* pattern : move.patterns) ids.push_back(pattern->id());
      return ids;
    }
  }
  return {};
}

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
  if (arrived_) return state_.status.say(PlanStatus::kArrived, {});
  // The map may change: it continues as soon as there is a path.
  if (!state_.map.goalSubstitutionReason().empty() &&
      isWithin(state_.map.target(), s.pose->T_map_body)) {
    progress.restart(s.now);
    return state_.status.say(PlanStatus::kUnreachable,
                             {state_.map.whyUnreachable(), state_.map.goalSubstitutionReason()});
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

void StandingControl::noPlan(const PlannerInputs& s, const Reason& why) {
  blocked_since_ = blocked_since_.value_or(s.now);
  state_.status.say(PlanStatus::kBlocked, why);
  if (!state_.steep && s.now - *blocked_since_ < state_.config.policy.recovery_wait) return;
  if (recovery_.tries() < state_.config.policy.recoveries) return tryRecovery(s);
  if (static_cast<int>(state_.map.detours()) >= state_.config.policy.detours) return;
  state_.map.addDetourAhead(s.pose->T_map_body.position(), state_.config.policy.detours);
  recovery_.restart();
}

void StandingControl::tryRecovery(const PlannerInputs& s) {
  const std::vector<int> ids =
      recovery_.propose(state_.table(), state_.map.collisionChecker(), s.pose->T_map_body);
  if (ids.empty()) return state_.status.say(PlanStatus::kBlocked, StopReason::kBoxedIn);
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
  state_.status.say(PlanStatus::kBlocked, StopReason::kGettingOut);
}

}  // namespace tread::planner
