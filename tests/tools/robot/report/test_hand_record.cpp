// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "tests/tools/robot/report/invented_drive.hpp"
#include "tools/robot/report/hand_record.hpp"

namespace tread::report {
namespace {

using namespace tread::samples;

motor_t handAt(double seconds, float command) {
  motor_t motor = motorAt(seconds, motor_t::STATE_MANUAL);
  motor.command[0] = motor.command[1] = command;
  return motor;
}

/// A plan whose first pattern, number 4, ends at a place.
plan_t shadowAt(double seconds, double x, double y) {
  plan_t plan = planAt(seconds, plan_t::PLAN_WAITING, "driven by hand by ada");
  plan.num_patterns = 1;
  plan.execution_id = {0};
  plan.pattern_id = {4};
  plan.pose = {{x, y, 0.0}};
  plan.covariance = {{0.0, 0.0, 0.0, 0.0, 0.0, 0.0}};
  return plan;
}

/// 10 s of manual driving at 0.5 m/s along x; `plan` returns the planner's plan for each second.
template <class Plan>
HandRecord tenSeconds(Plan&& plan, int16_t state_after) {
  std::vector<LogEvent> events;
  pattern_set_part_t part{};
  part.set_pattern_id = 4;
  part.set_period = 50'000;
  part.num_samples = 20;
  part.command.assign(20, {0.0, 0.0});
  part.trajectory.assign(20, {0.0, 0.0, 0.0});
  events.push_back(eventOf(kPatternSet, part));
  events.push_back(eventOf(kMotor, motorAt(0.9, motor_t::STATE_DRIVING)));
  for (int i = 0; i <= 200; ++i) {
    const double time = 1.0 + 0.05 * i;
    events.push_back(eventOf(kMotor, handAt(time, i < 100 ? 0.5F : 0.0F)));
    events.push_back(eventOf(kIns, insAt(time, 0.5 * 0.05 * i)));
    if (i % 20 == 0) events.push_back(eventOf(kPlan, plan(time, 0.5 * 0.05 * i)));
  }
  events.push_back(eventOf(kMotor, motorAt(11.05, state_after)));
  return HandRecord(timelineOf(DriveReader(std::move(events))));
}

}  // namespace

TEST_CASE("who drove how long, how often taken over and given back") {
  const auto none = [](double time, double) { return planAt(time, plan_t::PLAN_WAITING, "x"); };
  const HandRecord back = tenSeconds(none, motor_t::STATE_STOPPING);
  CHECK(back.taken_over == 1);
  CHECK(back.given_back == 1);
  CHECK(back.stopped == 0);
  CHECK(back.seconds == Approx(10.05));
  CHECK(back.moving == Approx(5.0));
  CHECK(back.distance == Approx(5.0));
  const HandRecord stopped = tenSeconds(none, motor_t::STATE_ESTOP);
  CHECK(stopped.given_back == 0);
  CHECK(stopped.stopped == 1);
  CHECK_THAT(stopped.words(), Catch::Contains("manual control: 10.0 s (5.0 s moving, 5.0 m)") &&
                                  Catch::Contains("stopped 1 times"));
}

TEST_CASE("a planner that would have gone the same way, faster, agrees") {
  const auto ahead = [](double time, double x) { return shadowAt(time, x + 1.0, 0.1); };
  const ShadowComparison shadow = tenSeconds(ahead, motor_t::STATE_STOPPING).shadow;
  CHECK(shadow.plans == 10);  // the result of the last one is unknown
  CHECK(shadow.same == 10);
  CHECK(shadow.would_stand == 0);
  CHECK(shadow.turned_away.front() == Approx(0.1).margin(0.01));
  CHECK(shadow.person_speed.front() == Approx(0.5).margin(0.05));
  CHECK(shadow.planner_speed.front() == Approx(1.0).margin(0.05));
}

TEST_CASE("a planner that would have turned away does not agree, and one that saw no way stands") {
  const auto aside = [](double time, double x) { return shadowAt(time, x, 1.0); };
  CHECK(tenSeconds(aside, motor_t::STATE_STOPPING).shadow.same == 0);
  const auto none = [](double time, double) {
    return planAt(time, plan_t::PLAN_WAITING, "driven by hand by ada; no way: boxed in");
  };
  const HandRecord record = tenSeconds(none, motor_t::STATE_STOPPING);
  CHECK(record.shadow.would_stand == record.shadow.plans);
  CHECK_THAT(record.words(),
             Catch::Contains("would have stopped in 100 %") && Catch::Contains("no way: boxed in"));
}

TEST_CASE("a log that nobody drove by hand says nothing of it") {
  CHECK(HandRecord(timelineOf(DriveReader(tenMetres()))).words().empty());
}

TEST_CASE("patterns that a person's driving taught are counted, those of the planner are not") {
  std::vector<LogEvent> events{eventOf(kMotor, handAt(1.0, 0.5F))};
  learning_t planners = learningAt(2.0, true, 0.1, 0.0);
  planners.learned_run_id = 7;
  events.push_back(eventOf(kLearning, planners));
  events.push_back(eventOf(kLearning, learningAt(2.0, true, 0.1, 0.0)));
  events.push_back(eventOf(kLearning, learningAt(3.0, false, 0.1, 0.0)));
  CHECK_THAT(HandRecord(timelineOf(DriveReader(std::move(events)))).words(),
             Catch::Contains("it gave 2 patterns to learn from, 1 of them fair"));
}

}  // namespace tread::report
