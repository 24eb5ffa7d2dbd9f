// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/drive/event_teller.hpp"
#include "common/messages/blank.hpp"

using namespace tread;

namespace {

/// Feeds messages at given times and stores the events.
class Story {
 public:
  template <class Message>
  void add(const Channel<Message>& channel, const Message& message) {
    utime_ += 100'000;
    LogEvent event = eventOf(channel, message);
    event.utime = utime_;
    for (const Event& told : teller_.take(event)) lines.push_back(told.source + ": " + told.words);
  }
  std::vector<std::string> lines;

 private:
  EventTeller teller_;
  int64_t utime_ = 1'000'000;
};

motor_t motor(int16_t state, const std::string& reason = "") {
  auto message = blank<motor_t>();
  message.bridge_state = state;
  message.state_reason = reason;
  return message;
}

plan_t plan(int16_t status, const std::string& reason = "") {
  auto message = blank<plan_t>();
  message.plan_status = status;
  message.reason = reason;
  return message;
}

health_t health(int16_t state, const std::string& reason, int64_t boot = 1) {
  auto message = blank<health_t>();
  message.process = "learner";
  message.health_state = state;
  message.health_reason = reason;
  message.boot_id = boot;
  return message;
}

using Lines = std::vector<std::string>;

}  // namespace

TEST_CASE("a state that is repeated is told once, and a new reason is told") {
  Story story;
  for (int i = 0; i < 3; ++i) story.add(kMotor, motor(motor_t::STATE_DISARMED, "not armed yet"));
  story.add(kMotor, motor(motor_t::STATE_DISARMED, "INS is stale"));
  REQUIRE(story.lines ==
          Lines{"motor_bridge: disarmed: not armed yet", "motor_bridge: disarmed: INS is stale"});
}

TEST_CASE(
    "a second emergency stop by the same person is told after another one cleared the first") {
  Story story;
  auto stop = blank<estop_t>();
  stop.engaged = true;
  stop.estop_by = "page (anna)";
  auto clear = blank<estop_t>();
  clear.estop_by = "tread-stop (ben)";
  for (const estop_t& message : {stop, stop, clear, clear, stop, stop}) story.add(kEstop, message);
  CHECK(story.lines == Lines{"page (anna): emergency stop",
                             "tread-stop (ben): clears the emergency stop",
                             "page (anna): emergency stop"});
}

TEST_CASE("standing between patterns is no event, losing the permission is one") {
  Story story;
  for (const int16_t state :
       {motor_t::STATE_ARMED, motor_t::STATE_DRIVING, motor_t::STATE_ARMED, motor_t::STATE_DRIVING})
    story.add(kMotor, motor(state));
  story.add(kMotor, motor(motor_t::STATE_FAULT, "the serial line is gone"));
  REQUIRE(story.lines ==
          Lines{"motor_bridge: armed", "motor_bridge: fault: the serial line is gone"});
}

TEST_CASE("the reason of a driving plan changes with every plan and is no event") {
  Story story;
  story.add(kPlan, plan(plan_t::PLAN_DRIVING, "stops in 3 m"));
  story.add(kPlan, plan(plan_t::PLAN_DRIVING, "stops in 2 m"));
  story.add(kPlan, plan(plan_t::PLAN_BLOCKED, "no pattern is free from here"));
  story.add(kPlan, plan(plan_t::PLAN_ARRIVED));
  REQUIRE(story.lines == Lines{"planner: driving", "planner: blocked: no pattern is free from here",
                               "planner: arrived"});
}

TEST_CASE("a process that is ill, well again and started again is told, one that is well is not") {
  Story story;
  story.add(kHealth, health(health_t::HEALTH_OK, ""));
  story.add(kHealth, health(health_t::HEALTH_DEGRADED, "no INS for 2 s"));
  story.add(kHealth, health(health_t::HEALTH_OK, ""));
  story.add(kHealth, health(health_t::HEALTH_OK, "", 2));
  REQUIRE(story.lines == Lines{"learner: DEGRADED: no INS for 2 s", "learner: recovered",
                               "learner: has started again"});
}

TEST_CASE("an aborted execution is told once, however often it is repeated") {
  Story story;
  auto executions = blank<execution_t>();
  auto record = blank<execution_record_t>();
  record.record_execution_id = 7;
  record.record_pattern_id = 3;
  record.commands_played = 4;
  record.commands_total = 20;
  record.outcome = execution_record_t::OUTCOME_ABORTED;
  record.outcome_reason = "the planner asked for a stop";
  executions.records = {record};
  executions.num_records = 1;
  story.add(kExecution, executions);
  story.add(kExecution, executions);
  REQUIRE(story.lines ==
          Lines{"motor_bridge: pattern 3 aborted after 4 of 20 commands: the planner "
                "asked for a stop"});
}

TEST_CASE("an INS that loses and finds its position is told") {
  Story story;
  auto ins = blank<ins_t>();
  ins.ins_status = ins_t::STATUS_GOOD;
  story.add(kIns, ins);
  ins.ins_status = ins_t::STATUS_NO_POSITION;
  story.add(kIns, ins);
  ins.ins_status = ins_t::STATUS_JUMP;
  story.add(kIns, ins);
  REQUIRE(story.lines == Lines{"ins_driver: no position", "ins_driver: no longer: no position",
                               "ins_driver: the position jumped further than the vehicle can"});
}
