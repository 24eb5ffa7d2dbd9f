// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/supervisor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tread::planner {
namespace {

/// How long a path that was given up is reported [us].
constexpr int64_t kNoteTime = 5'000'000;
/// On a slope a vehicle may creep endlessly without coming to a stand [us].
constexpr int64_t kSettleOnSlope = 600'000;

/// Weight of a turn of 1 rad/s as a speed [m/s].
constexpr double kTurnWeight = 0.5;

/// The motion class closest to a twist.
int nearestClass(const PatternTable& table, const Twist2& twist) {
  const std::vector<MotionClass>& classes = table.set().content().classes;
  const auto distance = [&twist](const MotionClass& motion) {
    return std::hypot(motion.twist.v_x - twist.v_x, motion.twist.v_y - twist.v_y,
                      kTurnWeight * (motion.twist.omega - twist.omega));
  };
  const auto nearest = std::min_element(
      classes.begin(), classes.end(),
      [&](const MotionClass& a, const MotionClass& b) { return distance(a) < distance(b); });
  return static_cast<int>(nearest - classes.begin());
}

}  // namespace

Supervisor::Supervisor(const PlannerConfig& config, int64_t run_id)
    : state_(config, run_id),
      moving_(state_),
      standing_(state_, moving_),
      progress_(config.policy.patience),
      slopes_(config.max_slope) {}

void Supervisor::setStoppingTime(double seconds) {
  // A PROGRAM, its transport to the motors, and the robot's motion until the next measurement.
  constexpr int64_t kDelay = 200'000;  // [us]
  state_.map.setStoppingTime(seconds);
  state_.config.policy.coast_time = seconds;
  state_.config.policy.stop_lead =
      std::max(PolicyConfig{}.stop_lead, static_cast<int64_t>(1e6 * seconds) + kDelay);
  slopes_.setStoppingTime(seconds);
}

void Supervisor::setGrip(const GripKnowledge& grip) {
  state_.grip = grip;
  if (!state_.set.limitSpeed(grip.stopWithin() * grip.deceleration)) return;
  state_.planner.setReplaced();
  state_.plan.expire();
}

bool Supervisor::takeSet(const PatternSet& set) {
  if (!state_.set.offer(set, state_.tracker)) return false;
  noteNewSet();
  return true;
}

/// The rest of the plan was predicted with the old set.
void Supervisor::noteNewSet() {
  ++state_.counters["sets taken"];
  state_.planner.setReplaced();
  state_.plan.expire();
}

Decision Supervisor::step(const PlannerInputs& s, const StopPredicate& stop) {
  state_.planner.setStop(stop);
  state_.status.changed = false;
  halted_ = {};
  state_.prediction.reset();
  if (s.pose) {
    standstill_.take(*s.pose);
    state_.track.push(s.pose->utime, s.pose->T_map_body);
    state_.map.setPositionStd(s.pose->position_std);
  }
  keepOffSlopes(s);
  followGoal(s);
  followBridge(s);
  if (state_.set.retry(state_.tracker)) noteNewSet();
  state_.planner.countCycle(state_.set.table(), state_.mode == DrivingMode::kDriving);
  was_armed_ = was_armed_ || (s.bridge && s.bridge->armed());
  const MapAndSet map_and_set{state_.map.newestUtime(),
                              state_.set.table() ? state_.table().defect() : "no PATTERN_SET yet",
                              was_armed_};
  act(s, checkPreconditions(s, map_and_set, state_.config.ages, state_.config.operators.lost));
  return {state_.status.changed, halted_, report(s)};
}

/// Plans from here on, without handing over.
void Supervisor::shadow(const PlannerInputs& s, const Preconditions& ready) {
  state_.tracker.stop();
  state_.mode = DrivingMode::kSettling;
  state_.settling_since = s.now;
  standing_.forgetBlocked();
  progress_.restart(s.now);
  if (ready.level != Preconditions::Level::kGo) {
    state_.plan.steps.clear();
    return state_.status.say(ready.status, ready.reason);
  }
  state_.map.updateCollisionChecker(s.pose->T_map_body, s.now);
  state_.map.updateDistance(s.pose->T_map_body, *s.goal, s.now);
  if (!state_.plan.due(s.now, state_.config.policy.plan_period)) return;
  PlanStep here;
  here.T_map_end = s.pose->T_map_body;
  here.exit_class =
      s.pose->twist ? nearestClass(state_.table(), *s.pose->twist) : state_.table().restClass();
  state_.planner.side().forget();
  const SearchResult result = state_.search(s.now, here, state_.config.policy.driving_expansions);
  state_.plan.steps = result.steps;
  Reason reason = s.bridge->reason;
  if (result.steps.empty()) reason.words += "; no way: " + result.reason.words;
  state_.status.say(PlanStatus::kWaiting, reason);
}

void Supervisor::act(const PlannerInputs& s, const Preconditions& ready) {
  const bool was_by_hand = by_hand_;
  by_hand_ = s.bridge && s.bridge->state == BridgeState::kManual;
  if (by_hand_ != was_by_hand) {
    state_.settle(s.now);
    state_.plan.expire();
  }
  if (by_hand_) return shadow(s, ready);
  if (ready.level == Preconditions::Level::kStop) {
    if (state_.mode == DrivingMode::kDriving) {
      state_.halt(s.now, ready.reason);
      halted_ = ready.reason;
    }
    standing_.forgetBlocked();
    progress_.restart(s.now);
    if (!s.goal && ready.status == PlanStatus::kWaiting)
      return state_.status.say(PlanStatus::kIdle, s.goal_lost);
    return state_.status.say(ready.status, ready.reason);
  }
  state_.map.updateCollisionChecker(s.pose->T_map_body, s.now);
  if (s.goal) state_.map.updateDistance(s.pose->T_map_body, *s.goal, s.now);
  if (s.goal && ready.level == Preconditions::Level::kGo && !standing_.arrived()) watchProgress(s);
  if (state_.mode == DrivingMode::kSettling) {
    const bool too_long = s.now - state_.settling_since >
                          (state_.steep ? kSettleOnSlope : state_.config.policy.settle_limit);
    if (standstill_.stands(state_.settling_since) || too_long) {
      state_.mode = DrivingMode::kStanding;
      state_.plan.made.reset();
    }
  }
  if (state_.mode == DrivingMode::kDriving) moving_.drive(s, ready);
  if (state_.mode == DrivingMode::kStanding) standing_.stand(s, ready, progress_);
}

void Supervisor::keepOffSlopes(const PlannerInputs& s) {
  if (!s.pose) return;
  const std::optional<Fence> steep = slopes_.take(*s.pose);
  state_.steep = slopes_.steep();
  if (!steep) return;
  state_.map.keepOut(*steep);
  ++state_.counters["too steep: keeps off"];
  if (state_.mode == DrivingMode::kDriving)
    state_.halt(s.now, {StopReason::kTilt, slopes_.words()});
}

void Supervisor::followGoal(const PlannerInputs& s) {
  std::optional<int64_t> id;
  if (s.goal) id = s.goal->id;
  if (id == goal_id_) return;
  goal_id_ = id;
  standing_.restart();
  state_.planner.side().forget();
  state_.map.forgetDetours();
  progress_.restart(s.now);
  state_.status.clearNote();
  state_.plan.made.reset();
  state_.status.changed = true;
}

void Supervisor::joinedNext() {
  std::vector<PlanStep>& steps = state_.plan.steps;
  const int pattern_id = state_.tracker.running().pattern_id;
  if (!steps.empty() && steps.front().pattern_id == pattern_id)
    steps.erase(steps.begin());
  else
    steps.clear();
  state_.planner.side().begun(pattern_id);
  state_.plan.expire();
  standing_.noteJoined();
  ++state_.counters["patterns joined"];
}

void Supervisor::followBridge(const PlannerInputs& s) {
  const ExecutionTracker& tracker = state_.tracker;
  const bool led_to_rest =
      !tracker.running().empty() && leadsToRest(tracker.running(), state_.table());
  switch (state_.tracker.follow(s)) {
    case ExecutionTracker::Event::kNone:
      return;
    case ExecutionTracker::Event::kSwitched:
      return joinedNext();
    case ExecutionTracker::Event::kEnded:
      ++state_.counters["came to rest"];
      if (!led_to_rest) state_.status.say(PlanStatus::kWaiting, StopReason::kNothingInTime);
      break;
    case ExecutionTracker::Event::kAborted:
      ++state_.counters["aborted by the bridge"];
      state_.status.say(
          PlanStatus::kWaiting,
          {tracker.abortReason().code, "stopped by motor_bridge: " + tracker.abortReason().words});
      break;
    case ExecutionTracker::Event::kNeverStarted:
      ++state_.counters["not begun by the bridge"];
      state_.status.say(PlanStatus::kWaiting,
                        {tracker.abortReason().code, "stopped: " + tracker.abortReason().words});
      break;
  }
  state_.settle(s.now);
  state_.plan.based_on.reset();
}

void Supervisor::watchProgress(const PlannerInputs& s) {
  const Eigen::Vector2d p = s.pose->T_map_body.position();
  const double distance = distanceToGoal().length(p);
  if (!std::isfinite(distance) || !progress_.stuck(distance, s.now)) return;
  ++state_.counters["no progress: a way given up"];
  const int64_t patience = state_.config.policy.patience / 1'000'000;
  state_.status.note(
      {StopReason::kLooksForAnotherWay,
       "no progress for " + std::to_string(patience) + " s: looking for another way"},
      s.now + kNoteTime);
  state_.map.addDetourAhead(p, state_.config.policy.detours);
}

PlanReport Supervisor::report(const PlannerInputs& s) const {
  const CurrentPlan& plan = state_.plan;
  const PlannedExecution& running = state_.tracker.running();
  const PlannedExecution& next = state_.tracker.next();
  PlanReport report;
  report.status = state_.status.status();
  report.reason = state_.status.reason();
  report.utime = s.pose ? s.pose->utime : 0;
  report.goal_id = s.goal ? s.goal->id : 0;
  report.set_version = state_.set.table() ? state_.table().set().version() : 0;
  report.time_to_go = state_.mode == DrivingMode::kDriving || by_hand_
                          ? plan.time_to_go
                          : std::numeric_limits<double>::quiet_NaN();
  report.risk = plan.steps.empty() ? PlanRisk() : plan.risk;
  report.expansions = state_.status.changed ? plan.expansions : 0;
  double time = 0.0;
  if (!running.empty() && state_.prediction) {
    time = state_.prediction->time_left;
    report.execution_ids.push_back(running.execution_id);
    report.steps.push_back({running.pattern_id, state_.prediction->T_map_end, 0, time,
                            state_.prediction->uncertainty});
  }
  for (size_t i = 0; i < plan.steps.size(); ++i) {
    const bool handed_over = i == 0 && plan.steps[i].pattern_id == next.pattern_id;
    report.execution_ids.push_back(handed_over ? next.execution_id : 0);
    report.steps.push_back(plan.steps[i]);
    report.steps.back().time += time;
  }
  return report;
}

}  // namespace tread::planner
