// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/execution/execution_tracker.hpp"
#include "modules/planner/core/execution/standing_control.hpp"
#include "tests/helpers.hpp"
#include "tests/planner/kit/sample_patterns.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

constexpr int64_t kRun = 5;
using tread::testing::kSecond;
using Event = ExecutionTracker::Event;
using Outcome = ExecutionOutcome;

PlannerInputs at(int64_t now) {
  PlannerInputs s;
  s.now = now;
  return s;
}

/// MOTOR reports this execution as running.
PlannerInputs playing(int64_t now, int64_t execution_id, int index = 0) {
  PlannerInputs s = at(now);
  s.bridge = BridgeReading{};
  s.bridge->utime = now;
  s.bridge->state = BridgeState::kDriving;
  s.bridge->run_id = kRun;
  s.bridge->execution_id = execution_id;
  s.bridge->command_index = index;
  return s;
}

ExecutionRecord record(int64_t id, int64_t started, Outcome outcome, int64_t run = kRun) {
  ExecutionRecord reading;
  reading.run_id = run;
  reading.execution_id = id;
  reading.started = started;
  reading.outcome = outcome;
  return reading;
}

/// A tracker whose first pattern (1 s, execution 1) began at 10 s and whose next is execution 2.
ExecutionTracker begun(const PatternSet& set) {
  ExecutionTracker tracker(kRun);
  tracker.begin(set, set.findByName("start")->id, 10 * kSecond);
  tracker.setNext(set, set.findByName("straight")->id);
  PlannerInputs s = playing(10 * kSecond, 1);
  s.executions = {record(1, 10 * kSecond, Outcome::kRunning)};
  REQUIRE(tracker.follow(s) == Event::kNone);
  REQUIRE(tracker.confirmed());
  return tracker;
}

}  // namespace

TEST_CASE(
    "Execution ids count up, and the same next pattern keeps its slot until a newer set predicts "
    "it") {
  const PatternSet set = samplePatterns(1);
  const PatternSet newer = samplePatterns(2);
  ExecutionTracker tracker(kRun);
  tracker.begin(set, 7, 0);
  tracker.setNext(set, 1);
  const int64_t first = tracker.next().execution_id;
  CHECK(first > tracker.running().execution_id);
  tracker.setNext(set, 1);
  CHECK(tracker.next().execution_id == first);
  tracker.setNext(newer, 1);
  const int64_t second = tracker.next().execution_id;
  CHECK(second > first);
  CHECK(tracker.next().set->version() == 2);
  tracker.setNext(newer, 2);
  CHECK(tracker.next().execution_id > second);
  CHECK(tracker.next().set->version() == 2);
}

TEST_CASE("The tracker switches when MOTOR names the next execution") {
  ExecutionTracker tracker = begun(samplePatterns());
  CHECK(tracker.follow(playing(11 * kSecond - 5000, 2)) == Event::kSwitched);
  CHECK(tracker.running().execution_id == 2);
  CHECK(tracker.next().empty());
  CHECK(tracker.started() == 11 * kSecond);
}

TEST_CASE("The tracker switches when EXECUTION says so, with the exact time of the beginning") {
  ExecutionTracker tracker = begun(samplePatterns());
  PlannerInputs s = at(11 * kSecond + 20'000);
  s.executions = {record(1, 10 * kSecond, Outcome::kCompleted),
                  record(2, 11 * kSecond + 10'000, Outcome::kRunning)};
  CHECK(tracker.follow(s) == Event::kSwitched);
  CHECK(tracker.started() == 11 * kSecond + 10'000);
}

TEST_CASE("The tracker switches by the clock where nothing is heard of the bridge") {
  ExecutionTracker tracker = begun(samplePatterns());
  CHECK(tracker.follow(at(11 * kSecond - 1)) == Event::kNone);
  CHECK(tracker.follow(at(11 * kSecond)) == Event::kSwitched);
  CHECK(tracker.running().execution_id == 2);
}

TEST_CASE("A next pattern that was replaced too late is what runs") {
  const PatternSet set = samplePatterns();
  ExecutionTracker tracker = begun(set);
  tracker.setNext(set, set.findByName("left")->id);  // execution 3, but the bridge already plays 2
  CHECK(tracker.follow(playing(11 * kSecond, 2)) == Event::kSwitched);
  CHECK(tracker.running().execution_id == 2);
  CHECK(tracker.running().pattern_id == set.findByName("straight")->id);
}

TEST_CASE("A series that ended without its next is an end, whatever the clock said") {
  ExecutionTracker tracker = begun(samplePatterns());
  REQUIRE(tracker.follow(at(11 * kSecond + 1)) == Event::kSwitched);
  PlannerInputs s = at(11 * kSecond + 50'000);
  s.executions = {record(1, 10 * kSecond, Outcome::kCompleted)};
  CHECK(tracker.follow(s) == Event::kEnded);
  CHECK(tracker.running().empty());
}

TEST_CASE("An abort empties the program and keeps the reason") {
  ExecutionTracker tracker = begun(samplePatterns());
  PlannerInputs s = at(10 * kSecond + 500'000);
  s.executions = {record(1, 10 * kSecond, Outcome::kAborted)};
  s.executions.back().reason = StopReason::kInsStale;
  CHECK(tracker.follow(s) == Event::kAborted);
  CHECK(tracker.abortReason() == Reason(StopReason::kInsStale));
  CHECK(tracker.running().empty());
  CHECK(tracker.next().empty());
}

TEST_CASE("Executions of another run concern nobody") {
  ExecutionTracker tracker = begun(samplePatterns());
  PlannerInputs s = at(10 * kSecond + 500'000);
  s.executions = {record(1, 10 * kSecond, Outcome::kAborted, kRun - 1)};
  CHECK(tracker.follow(s) == Event::kNone);
}

TEST_CASE("A pattern that the bridge does not begin within a second is taken back") {
  const PatternSet set = samplePatterns();
  ExecutionTracker tracker(kRun);
  tracker.begin(set, 7, 0);
  CHECK(tracker.follow(at(900'000)) == Event::kNone);
  CHECK(tracker.follow(at(1'100'000)) == Event::kNeverStarted);
  CHECK(tracker.running().empty());
  tracker.begin(set, 7, 2 * kSecond);
  CHECK(tracker.running().execution_id == 2);
}

TEST_CASE("A standing bridge in the middle of a pattern means that it was aborted") {
  ExecutionTracker tracker = begun(samplePatterns());
  PlannerInputs s = at(10 * kSecond + 500'000);
  s.bridge = BridgeReading{};
  s.bridge->utime = s.now;
  s.bridge->state = BridgeState::kDisarmed;
  s.bridge->reason = {StopReason::kUnsaid, "no good PROGRAM within its lease"};
  CHECK(tracker.follow(s) == Event::kAborted);
}

TEST_CASE("Standing is told from the twist where it is measured, from the poses where not") {
  for (const bool measured : {true, false}) {
    StandstillDetector watch;
    for (int64_t t = 0; t <= 1'000'000; t += 20'000) {
      const double speed = t < 500'000 ? 0.5 : 0.0;
      PoseReading pose;
      pose.utime = t;
      pose.T_map_body.x = t < 500'000 ? 0.5e-6 * static_cast<double>(t) : 0.25;
      if (measured) pose.twist = Twist2{speed, 0.0, 0.0};
      watch.take(pose);
      if (t < 640'000) CHECK(!watch.stands(0));
    }
    CHECK(watch.stands(0));
    CHECK(!watch.stands(900'000));
  }
}

TEST_CASE("Without progress for its patience the watch says so, dead ends being news") {
  ProgressMonitor watch(10 * kSecond);
  watch.restart(0);
  CHECK(!watch.stuck(20.0, kSecond));
  CHECK(!watch.stuck(18.0, 5 * kSecond));
  CHECK(!watch.stuck(17.9, 14 * kSecond));
  CHECK(watch.stuck(17.9, 15 * kSecond));
  CHECK(!watch.stuck(30.0, 24 * kSecond));
  CHECK(!watch.stuck(30.0, 33 * kSecond));
  CHECK(watch.stuck(30.0, 34 * kSecond));
}
