// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/drive/event_teller.hpp"

#include <cmath>

#include "common/bus/bus.hpp"
#include "common/report/text.hpp"

namespace tread {
namespace {

/// A sender can invent any number of names; a robot has a few dozen.
constexpr size_t kMostNames = 500;
constexpr size_t kMostAborted = 10'000;  // executions

struct StateWords {
  int16_t state;
  const char* words;
  Severity severity;
};

constexpr StateWords kMotorStates[] = {{motor_t::STATE_DISARMED, "disarmed", Severity::kWarning},
                                       {motor_t::STATE_ARMED, "armed, standing", Severity::kInfo},
                                       {motor_t::STATE_DRIVING, "driving", Severity::kInfo},
                                       {motor_t::STATE_STOPPING, "stopping", Severity::kWarning},
                                       {motor_t::STATE_FAULT, "fault", Severity::kError},
                                       {motor_t::STATE_ESTOP, "emergency stop", Severity::kError},
                                       {motor_t::STATE_MANUAL, "driven by hand", Severity::kInfo}};

constexpr StateWords kPlanStates[] = {
    {plan_t::PLAN_IDLE, "no goal", Severity::kInfo},
    {plan_t::PLAN_DRIVING, "driving", Severity::kInfo},
    {plan_t::PLAN_ARRIVED, "arrived", Severity::kInfo},
    {plan_t::PLAN_WAITING, "waiting", Severity::kWarning},
    {plan_t::PLAN_BLOCKED, "blocked", Severity::kWarning},
    {plan_t::PLAN_UNREACHABLE, "goal cannot be reached", Severity::kError},
    {plan_t::PLAN_STOPPED, "stopped", Severity::kError}};

struct StatusWords {
  int32_t bit;
  const char* words;
};

constexpr StatusWords kInsStatus[] = {{ins_t::STATUS_NO_POSITION, "no position"},
                                      {ins_t::STATUS_NO_HEADING, "no heading"},
                                      {ins_t::STATUS_FILLED_IN, "filled in by scan matching"}};

template <size_t size>
StateWords wordsOf(const StateWords (&table)[size], int16_t state) {
  for (const StateWords& row : table)
    if (row.state == state) return row;
  return {state, "unknown state", Severity::kWarning};
}

std::string withReason(const std::string& words, const std::string& reason) {
  return reason.empty() ? words : words + ": " + reason;
}

}  // namespace

std::vector<Event> EventTeller::take(const LogEvent& event) {
  now_ = event.utime;
  channel_ = event.channel;
  told_.clear();
  if (states_.size() > kMostNames) states_.clear();
  if (boots_.size() > kMostNames) boots_.clear();
  if (aborted_.size() > kMostAborted) aborted_.erase(aborted_.begin());
  dispatch(
      event, [this](const auto& message) { hear(message); }, kMotor, kPlan, kHealth, kLearning,
      kExecution, kArm, kEstop, kGoal, kFence, kMark, kIns);
  return std::move(told_);
}

void EventTeller::tell(Severity severity, const std::string& source, const std::string& words) {
  told_.push_back({now_, severity, channel_, source, words});
}

bool EventTeller::changes(const std::string& source, const std::string& state) {
  std::string& known = states_[source];
  if (known == state) return false;
  known = state;
  return true;
}

void EventTeller::hear(const motor_t& motor) {
  const StateWords state = wordsOf(kMotorStates, motor.bridge_state);
  // A short stop between patterns is no event.
  const bool moves =
      motor.bridge_state == motor_t::STATE_ARMED || motor.bridge_state == motor_t::STATE_DRIVING;
  if (changes("motors", moves ? "armed" : withReason(state.words, motor.state_reason)))
    tell(state.severity, "motor_bridge",
         moves ? "armed" : withReason(state.words, motor.state_reason));
}

void EventTeller::hear(const plan_t& plan) {
  const StateWords state = wordsOf(kPlanStates, plan.plan_status);
  // While driving, the reason describes a future stop and changes with every plan.
  const bool drives = plan.plan_status == plan_t::PLAN_DRIVING;
  const std::string words = drives ? state.words : withReason(state.words, plan.reason);
  if (changes("plan", words)) tell(state.severity, "planner", words);
}

void EventTeller::hear(const health_t& health) {
  const auto [boot, first] = boots_.try_emplace(health.process, health.boot_id);
  if (!first && boot->second != health.boot_id) {
    tell(Severity::kWarning, health.process, "has started again");
    boot->second = health.boot_id;
  }
  const bool known = states_.count("health of " + health.process) > 0;
  const bool ok = health.health_state == health_t::HEALTH_OK;
  if (!changes("health of " + health.process, inWords(health)) || (ok && !known)) return;
  tell(ok                                               ? Severity::kInfo
       : health.health_state == health_t::HEALTH_FAILED ? Severity::kError
                                                        : Severity::kWarning,
       health.process, ok ? "recovered" : inWords(health));
}

void EventTeller::hear(const learning_t& learning) {
  std::string words = learning.learned_pattern_name + ": ";
  if (!learning.accepted)
    words += "not learned from: " + learning.gate_reason;
  else
    words += formatted("ended %.2f m and %.1f deg from its prediction", learning.error_position,
                       learning.error_yaw * 180.0 / 3.14159265358979) +
             (learning.changed ? "; " + learning.change_reason : "");
  tell(Severity::kInfo, "learner", words);
}

void EventTeller::hear(const execution_t& executions) {
  for (const execution_record_t& record : executions.records)
    if (record.outcome == execution_record_t::OUTCOME_ABORTED &&
        aborted_.insert(keyOf(record)).second)
      tell(Severity::kWarning, "motor_bridge",
           formatted("pattern %d aborted after %d of %d commands: ", record.record_pattern_id,
                     record.commands_played, record.commands_total) +
               record.outcome_reason);
}

void EventTeller::hear(const arm_t& arm) {
  const std::string words = withReason(arm.armed ? "arms" : "disarms", arm.arm_reason);
  if (changes("arm of " + arm.armed_by, words + std::to_string(arm.utime / 2'000'000)))
    tell(Severity::kInfo, arm.armed_by, words);
}

void EventTeller::hear(const estop_t& estop) {
  const std::string words = withReason(
      estop.engaged ? "emergency stop" : "clears the emergency stop", estop.estop_reason);
  // A stop after a clearance is a new one, whoever sent the same words before.
  if (changes("estop", estop.engaged ? "engaged" : "cleared")) {
    const std::string of_all = "estop of ";
    for (auto at = states_.lower_bound(of_all);
         at != states_.end() && at->first.compare(0, of_all.size(), of_all) == 0;)
      at = states_.erase(at);
  }
  if (changes("estop of " + estop.estop_by, words))
    tell(estop.engaged ? Severity::kError : Severity::kInfo, estop.estop_by, words);
}

void EventTeller::hear(const goal_t& goal) {
  if (!changes("goal", std::to_string(goal.goal_id))) return;
  tell(Severity::kInfo, "operator",
       goal.goal_id == 0
           ? "cancels the goal"
           : formatted("goal at x %.1f m, y %.1f m", goal.goal_pose[0], goal.goal_pose[1]));
}

void EventTeller::hear(const fence_t& fence) {
  const char* const what = fence.fence_kind == fence_t::FENCE_REMOVED    ? "removes fence "
                           : fence.fence_kind == fence_t::FENCE_KEEP_OUT ? "keep-out fence "
                                                                         : "stay-in fence ";
  if (changes("fence " + fence.fence_name, what))
    tell(Severity::kInfo, fence.fence_by.empty() ? "operator" : fence.fence_by,
         what + fence.fence_name);
}

void EventTeller::hear(const mark_t& mark) {
  if (changes("mark " + mark.mark_kind, mark.mark_value))
    tell(Severity::kInfo, "operator", mark.mark_kind + ": " + mark.mark_value);
}

void EventTeller::hear(const ins_t& ins) {
  for (const StatusWords& status : kInsStatus) {
    const bool now = (ins.ins_status & status.bit) != 0;
    if (now == ((ins_status_ & status.bit) != 0) && ins_heard_) continue;
    if (now)
      tell(Severity::kWarning, "ins_driver", status.words);
    else if (ins_heard_)
      tell(Severity::kInfo, "ins_driver", std::string("no longer: ") + status.words);
  }
  if ((ins.ins_status & ins_t::STATUS_JUMP) != 0 && ins_heard_)
    tell(Severity::kWarning, "ins_driver", "the position jumped further than the vehicle can");
  if ((ins.ins_status & ins_t::STATUS_GAP) != 0 && ins_heard_)
    tell(Severity::kWarning, "ins_driver", "messages were missing before this one");
  ins_status_ = ins.ins_status;
  ins_heard_ = true;
}

}  // namespace tread
