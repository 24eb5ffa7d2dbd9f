// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/study/hide/bad_log.hpp"
#include "tests/study/hide/blind_bench.hpp"
#include "tests/study/hide/blind_log.hpp"
#include "tests/study/hide/effect_list.hpp"
#include "tests/study/hide/event_edit.hpp"

using namespace tread;
using namespace tread::blind;
using tread::blind::bench::shortPlan;

namespace {

MadeCase badCase(const std::string& defect) {
  CasePlan plan = shortPlan({});
  plan.kind = CaseKind::kBad;
  plan.defect = defect;
  return makeCase(plan);
}

template <class Message>
int64_t largestStepBack(const std::vector<Message>& messages) {
  int64_t back = 0;
  for (size_t i = 1; i < messages.size(); ++i)
    back = std::max(back, messages[i - 1].utime - messages[i].utime);
  return back;
}

template <class Message>
int64_t largestGap(const std::vector<Message>& messages) {
  int64_t gap = 0;
  for (size_t i = 1; i < messages.size(); ++i)
    gap = std::max(gap, messages[i].utime - messages[i - 1].utime);
  return gap;
}

}  // namespace

TEST_CASE("a log has MOTOR at 20 Hz and INS at 50 Hz from a clock that does not begin at zero") {
  const MadeCase made = makeCase(shortPlan({}));
  const auto motors = messagesOf(made.events, kMotor);
  const auto ins = messagesOf(made.events, kIns);
  CHECK(motors.size() == 120 * 20 + 1);
  CHECK(ins.size() >= 120 * 50 - 1);
  CHECK(motors.front().utime > 1'000'000'000);
  for (size_t i = 1; i < motors.size(); ++i)
    CHECK(std::abs(static_cast<double>(motors[i].utime - motors[i - 1].utime - 50'000)) <= 300.0);
  for (size_t i = 1; i < ins.size(); ++i) CHECK(ins[i].utime - ins[i - 1].utime == 20'000);
  CHECK(messagesOf(made.events, kConfig).size() >= 12);
  CHECK(messagesOf(made.events, kMark).size() == 5);
  for (size_t i = 1; i < made.events.size(); ++i)
    CHECK(made.events[i].utime >= made.events[i - 1].utime);
}

TEST_CASE("every pattern is an execution of 40 commands, begun and ended at a command") {
  const MadeCase made = makeCase(shortPlan({}));
  const auto motors = messagesOf(made.events, kMotor);
  std::map<int64_t, execution_record_t> records;
  for (const execution_t& message : messagesOf(made.events, kExecution)) {
    CHECK(message.records.size() <= 8);
    for (const execution_record_t& record : message.records)
      records[record.record_execution_id] = record;
  }
  std::map<int64_t, std::vector<motor_t>> commands;
  for (const motor_t& motor : motors)
    if (motor.execution_id != 0) commands[motor.execution_id].push_back(motor);
  REQUIRE(records.size() > 30);
  REQUIRE(records.size() == commands.size());
  for (const auto& [id, record] : records) {
    const auto& played = commands[id];
    REQUIRE(played.size() == 40);
    CHECK(record.outcome == execution_record_t::OUTCOME_COMPLETED);
    CHECK(record.commands_played == 40);
    CHECK(record.started == played.front().utime);
    CHECK(std::abs(static_cast<double>(record.ended - record.started - 2'000'000)) <= 300.0);
    for (const motor_t& motor : played) {
      CHECK(motor.command[0] == played.front().command[0]);
      CHECK(std::abs(motor.command[0]) <= 1.0f);
    }
  }
}

TEST_CASE("the vehicle stands at both ends of a log") {
  CasePlan plan = shortPlan({});
  plan.minutes = 10.0;
  const MadeCase made = makeCase(plan);
  const auto motors = messagesOf(made.events, kMotor);
  for (const motor_t& motor : motors) {
    const bool end = motor.utime - motors.front().utime < 24'000'000 ||
                     motors.back().utime - motor.utime < 24'000'000;
    if (end) CHECK(motor.command[0] == 0.0f);
  }
}

TEST_CASE("nothing in a log tells what is hidden") {
  CasePlan plan = shortPlan({"motor_deadband"});
  const MadeCase made = makeCase(plan);
  for (const LogEvent& event : made.events) {
    const std::string bytes(event.bytes.begin(), event.bytes.end());
    for (const EffectSpec& effect : effectList())
      REQUIRE(bytes.find(effect.name) == std::string::npos);
  }
  plan.effects = {};
  plan.kind = CaseKind::kNull;
  const auto plain = messagesOf(makeCase(plan).events, kMotor);
  const auto hidden = messagesOf(made.events, kMotor);
  REQUIRE(plain.size() == hidden.size());
  for (size_t i = 0; i < plain.size(); ++i) {
    CHECK(plain[i].utime == hidden[i].utime);
    CHECK(plain[i].command[0] == hidden[i].command[0]);
    CHECK(plain[i].state_reason == hidden[i].state_reason);
  }
}

TEST_CASE("a jumped clock jumps by seven seconds on all channels") {
  const MadeCase made = badCase("clock_jump");
  const auto ins = messagesOf(made.events, kIns);
  const auto motors = messagesOf(made.events, kMotor);
  const int64_t ahead = largestGap(ins), back = largestStepBack(ins);
  CHECK((ahead > 6'900'000 || back > 6'900'000));
  CHECK((largestGap(motors) > 6'900'000) == (ahead > 6'900'000));
  CHECK((largestStepBack(motors) > 6'900'000) == (back > 6'900'000));
}

TEST_CASE("a frozen INS repeats its last pose under new stamps") {
  const auto ins = messagesOf(badCase("frozen_ins").events, kIns);
  const ins_t& last = ins.back();
  size_t same = 0;
  for (const ins_t& one : ins)
    same += one.position[0] == last.position[0] && one.rate[2] == last.rate[2] ? 1 : 0;
  CHECK(same > ins.size() / 3);
  CHECK(same < ins.size());
  CHECK(largestStepBack(ins) == -20'000 + 20'000);
}

TEST_CASE("a flipped gyro turns against the heading") {
  const auto good = messagesOf(makeCase(shortPlan({})).events, kIns);
  const auto bad = messagesOf(badCase("flipped_gyro").events, kIns);
  REQUIRE(good.size() == bad.size());
  for (size_t i = 0; i < good.size(); ++i) {
    CHECK(bad[i].rate[2] == -good[i].rate[2]);
    CHECK(bad[i].orientation[3] == good[i].orientation[3]);
  }
}

TEST_CASE("a log without MOTOR has none, and two robots tell two places at once") {
  CHECK(messagesOf(badCase("no_motor").events, kMotor).empty());
  const auto ins = messagesOf(badCase("two_robots").events, kIns);
  CHECK(ins.size() > 2 * 110 * 50);
  double jump = 0.0;
  for (size_t i = 1; i < ins.size(); ++i)
    jump = std::max(jump, std::hypot(ins[i].position[0] - ins[i - 1].position[0],
                                     ins[i].position[1] - ins[i - 1].position[1]));
  CHECK(jump > 1.0);
}
