// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "common/log/event_log.hpp"
#include "common/messages/blank.hpp"
#include "tests/helpers.hpp"

namespace tread::samples {

using tread::testing::kSecond;

inline goal_t goalAt(double seconds, double x, int64_t id = 1) {
  auto goal = blank<goal_t>();
  goal.utime = std::llround(seconds * 1e6);
  goal.goal_id = id;
  goal.goal_pose[0] = x;
  goal.goal_pose[1] = goal.goal_pose[2] = 0.0;
  return goal;
}

inline plan_t planAt(double seconds, int16_t status, const std::string& reason = "",
                     int64_t set_version = 1) {
  auto plan = blank<plan_t>();
  plan.utime = std::llround(seconds * 1e6);
  plan.goal_id = 1;
  plan.set_version = set_version;
  plan.plan_status = status;
  plan.reason = reason;
  return plan;
}

inline motor_t motorAt(double seconds, int16_t state) {
  auto motor = blank<motor_t>();
  motor.utime = std::llround(seconds * 1e6);
  motor.bridge_state = state;
  return motor;
}

/// Straight ahead along x.
inline ins_t insAt(double seconds, double x) {
  auto ins = blank<ins_t>();
  ins.utime = std::llround(seconds * 1e6);
  ins.ins_status = ins_t::STATUS_GOOD;
  ins.position[0] = x;
  ins.position[1] = ins.position[2] = 0.0;
  ins.orientation[0] = 1.0;
  ins.orientation[1] = ins.orientation[2] = ins.orientation[3] = 0.0;
  return ins;
}

inline execution_t executionAt(double seconds, int64_t id, int16_t outcome) {
  auto execution = blank<execution_t>();
  execution.utime = std::llround(seconds * 1e6);
  execution_record_t record{};
  record.record_run_id = 7;
  record.record_execution_id = id;
  record.outcome = outcome;
  record.ended = execution.utime;
  execution.records.push_back(record);
  execution.num_records = 1;
  return execution;
}

inline learning_t learningAt(double seconds, bool accepted, double position, double yaw) {
  auto learning = blank<learning_t>();
  learning.utime = std::llround(seconds * 1e6);
  learning.accepted = accepted;
  learning.error_position = position;
  learning.error_yaw = yaw;
  return learning;
}

/// 10 s at 1 m/s to a goal 10 m ahead, from second 5 on; the caller adds the end.
inline std::vector<LogEvent> tenMetres() {
  std::vector<LogEvent> events;
  events.push_back(eventOf(kMotor, motorAt(5.0, motor_t::STATE_ARMED)));
  events.push_back(eventOf(kGoal, goalAt(5.0, 10.0)));
  for (int i = 0; i <= 100; ++i) {
    events.push_back(eventOf(kIns, insAt(5.0 + 0.1 * i, 0.1 * i)));
    if (i % 10 == 5) events.push_back(eventOf(kPlan, planAt(5.0 + 0.1 * i, plan_t::PLAN_DRIVING)));
  }
  return events;
}

inline std::string writeLog(const std::string& path, const std::vector<LogEvent>& events) {
  LogWriter log(path);
  for (const LogEvent& event : events)
    log.write(event.utime, event.channel, event.bytes.data(), event.bytes.size());
  return path;
}

}  // namespace tread::samples
