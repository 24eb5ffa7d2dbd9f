// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <array>
#include <cstdio>

#include "tests/helpers.hpp"
#include "tests/planner/kit/closed_loop.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

Mission slalom() {
  Mission mission;
  for (int i = 0; i < 4; ++i) {
    const double x = 5.0 + 5.0 * i;
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    mission.ground.addWall({x, side * 0.2}, {x, side * -5.0}, 0.3);
  }
  mission.ground.addWall({-3.0, 5.0}, {28.0, 5.0});
  mission.ground.addWall({-3.0, -5.0}, {28.0, -5.0});
  mission.goal = {1, {25.5, 0.0, 0.0}, 0.5, 4.0};
  return mission;
}

void mustArrive(const DriveOutcome& outcome) {
  std::printf("  %.1f s, %.1f m, %d patterns, least clearance %.3f m, planner %.1f ms/s\n",
              outcome.time, outcome.distance, outcome.patterns, outcome.least_clearance,
              1e3 * outcome.planner_seconds / outcome.time);
  INFO(outcome.reason);
  CHECK(outcome.status == PlanStatus::kArrived);
  CHECK(outcome.collisions == 0);
  CHECK(outcome.least_clearance > 0.0);
}

}  // namespace

TEST_CASE("With 5 % prediction error the slalom is driven without touching") {
  for (int seed = 1; seed <= testing::effort(3); ++seed) {
    DriveOptions options;
    options.seed = static_cast<uint64_t>(seed);
    mustArrive(driveMission(slalom(), samplePatterns(), options));
  }
}

TEST_CASE("Out of a pocket that is seen only from inside the way around it is found") {
  Mission mission;
  mission.ground.addWall({8.0, -3.0}, {8.0, 3.0});
  mission.ground.addWall({4.0, 3.0}, {8.0, 3.0});
  mission.ground.addWall({4.0, -3.0}, {8.0, -3.0});
  mission.goal = {1, {14.0, 0.0, 0.0}, 0.5, 4.0};
  DriveOptions options;
  mustArrive(driveMission(mission, samplePatterns(), options));
}

TEST_CASE("A gap of the vehicle's width and 0.4 m is driven through in a walled yard") {
  Mission mission;
  mission.ground.addWall({6.0, -8.0}, {6.0, 2.46}, 0.4);
  mission.ground.addWall({6.0, 3.54}, {6.0, 8.0}, 0.4);
  mission.ground.addWall({-4.0, 8.0}, {16.0, 8.0});
  mission.ground.addWall({-4.0, -8.0}, {16.0, -8.0});
  mission.ground.addWall({-4.0, -8.0}, {-4.0, 8.0});
  mission.ground.addWall({16.0, -8.0}, {16.0, 8.0});
  mission.goal = {1, {12.0, -3.0, 0.0}, 0.5, 4.0};
  for (int seed = 1; seed <= testing::effort(3); ++seed) {
    DriveOptions options;
    options.seed = static_cast<uint64_t>(seed);
    mustArrive(driveMission(mission, samplePatterns(), options));
  }
}

TEST_CASE(
    "Missions in yards with narrow gaps and pockets arrive although the ground turns 15 % more",
    "[statistics]") {
  for (int i = 0; i < testing::effort(6); ++i) {
    const auto seed = static_cast<uint64_t>(1001 + i);
    DriveOptions options;
    options.seed = seed;
    options.errors.turn_bias = 1.15;
    mustArrive(driveMission(randomMission(seed), samplePatterns(), options));
  }
}

TEST_CASE("A heading at the goal is reached, too") {
  Mission mission;
  mission.goal = {1, {8.0, 3.0, kPi / 2.0}, 0.4, 0.3};
  DriveOptions options;
  const DriveOutcome outcome = driveMission(mission, samplePatterns(), options);
  mustArrive(outcome);
}

TEST_CASE("A goal that is enclosed is called unreachable, and the vehicle stays") {
  Mission mission;
  mission.ground.addWall({5.0, -2.0}, {9.0, -2.0});
  mission.ground.addWall({9.0, -2.0}, {9.0, 2.0});
  mission.ground.addWall({9.0, 2.0}, {5.0, 2.0});
  mission.ground.addWall({5.0, 2.0}, {5.0, -2.0});
  mission.goal = {1, {7.0, 0.0, 0.0}, 0.4, 4.0};
  DriveOptions options;
  options.whole_map_known = true;
  options.time_limit = 3.0;
  const DriveOutcome outcome = driveMission(mission, samplePatterns(), options);
  CHECK(outcome.status == PlanStatus::kUnreachable);
  CHECK(!outcome.reason.empty());
  CHECK(outcome.distance < 0.01);
}

TEST_CASE("A boulder that appears ahead is not driven into") {
  Mission mission;
  mission.goal = {1, {20.0, 0.0, 0.0}, 0.5, 4.0};
  const std::array<double, 3> distances{1.6, 2.2, 3.0};
  for (int i = 0; i < testing::effort(3); ++i) {
    const double ahead = distances[static_cast<size_t>(i)];
    DriveOptions options;
    bool dropped = false;
    options.on_step = [&](double time, const Pose2& pose, Supervisor&, Playground& ground) {
      if (dropped || time < 5.0) return;
      dropped = true;
      const Pose2 there = pose * Pose2{ahead + 0.3, 0.1, 0.0};
      ground.add({there, 0.3, 0.6});
    };
    mustArrive(driveMission(mission, samplePatterns(), options));
  }
}

TEST_CASE("Sets are exchanged between cycles, what was handed over keeps its version") {
  Mission mission = slalom();
  DriveOptions options;
  int64_t version = 1;
  bool consistent = true;
  std::map<int64_t, int64_t> versions;
  options.on_step = [&](double time, const Pose2&, Supervisor& supervisor, Playground&) {
    for (const PlannedExecution* slot :
         {&supervisor.program().running(), &supervisor.program().next()}) {
      if (slot->empty()) continue;
      const auto known = versions.emplace(slot->execution_id, slot->set->version()).first;
      consistent = consistent && known->second == slot->set->version();
    }
    if (time < 0.7 * static_cast<double>(version)) return;
    ++version;
    supervisor.takeSet(samplePatterns(version, version % 2 == 0 ? 1.05 : 0.95));
  };
  mustArrive(driveMission(mission, samplePatterns(), options));
  CHECK(consistent);
  CHECK(versions.rbegin()->second > 10);
}

TEST_CASE("The same seed drives the same way to the last digit", "[statistics]") {
  DriveOptions options;
  options.seed = 9;
  const DriveOutcome first = driveMission(slalom(), samplePatterns(), options);
  const DriveOutcome second = driveMission(slalom(), samplePatterns(), options);
  CHECK(first.distance == second.distance);
  CHECK(first.time == second.time);
  CHECK(first.counters == second.counters);
}
