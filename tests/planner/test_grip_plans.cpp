// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Plans on slippery ground, and through narrow passages.
#include <catch2/catch.hpp>

#include "common/pattern/pattern_file.hpp"
#include "tests/helpers.hpp"
#include "tests/planner/kit/policy_rig.hpp"
#include "tests/planner/kit/search_bench.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

/// Two speeds forward, .49 and 1.08 m/s.
PatternSet twoSpeeds() {
  return readPatternFile(std::string(TREAD_SOURCE_DIR) + "/config/patterns/teodor_speeds.yaml");
}

/// A wall across the path, at x [m].
Playground wallAt(double x) {
  Playground ground;
  ground.addWall({x + 0.1, -9.0}, {x + 0.1, 9.0});
  return ground;
}

int64_t counted(Rig& rig, const std::string& name) {
  const auto& counters = rig.supervisor().counters();
  const auto found = counters.find(name);
  return found == counters.end() ? 0 : found->second;
}

double speedOf(const PatternSet& set, const std::string& motion_class) {
  return std::abs(set.classNamed(motion_class).twist.v_x);
}

}  // namespace

TEST_CASE("After each pattern of a plan the vehicle may slide until this ground has stopped it") {
  const double deceleration = GENERATE(0.3, 0.5, 0.8);
  const Playground ground = wallAt(6.0);
  const Goal goal{1, {4.0, 0.0, 0.0}, 0.5, 4.0};
  const SearchBench bench(ground.paint(0.1, {-4.8, -4.8}, {9.6, 4.8}), twoSpeeds(), goal);
  SearchProblem problem = bench.problem({0.0, 0.0, 0.0});
  const auto nearest = [&] {
    PatternSearch search{SearchConfig{}};
    const SearchResult result = search.run(problem, after(20000));
    REQUIRE(result.end != SearchEnd::kNothing);
    double room = 1e9;
    for (const PlanStep& step : result.steps) {
      const Eigen::Vector2d v = bench.table.find(step.pattern_id)->v_exit;
      const double way = v.squaredNorm() / (2.0 * deceleration);
      if (v.norm() < 0.1) continue;
      const Pose2 slid =
          step.T_map_end * Pose2{way * v.x() / v.norm(), way * v.y() / v.norm(), 0.0};
      room = std::min(room, ground.clearance(kVehicle, slid));
    }
    return room;
  };
  problem.deceleration = deceleration;
  CHECK(nearest() > 0.0);
  // Otherwise the plan assumes the stopping distance of the set's ground.
  problem.deceleration = kNoLimit;
  if (deceleration < 0.5) CHECK(nearest() <= 0.0);
}

TEST_CASE("Where the ground gave way only slow patterns begin, and those that slow down remain") {
  ActiveSet active(usualSweep(), {});
  const PatternSet set = twoSpeeds();
  REQUIRE(active.offer(set, ExecutionTracker(1)));
  const auto begins = [&](const std::string& motion_class) {
    return active.table()->from(active.table()->classIndex(motion_class)).size();
  };
  const size_t from_rest = begins("rest"), from_cruise = begins("cruise");
  active.limitSpeed(0.6);
  for (int i = 0; i < active.table()->classCount(); ++i)
    for (const TablePattern* pattern : active.table()->from(i))
      CHECK(speedOf(set, pattern->pattern->exit_class) < 0.7);
  CHECK(begins("rest") < from_rest);
  CHECK(begins("rest") > 0);
  CHECK(begins("cruise") > 0);
  CHECK(begins("cruise") < from_cruise);
  // The slowest class that drives forward always remains: it stops by itself if requested.
  active.limitSpeed(0.01);
  CHECK(begins("rest") > 0);
  CHECK(begins("slow") > 0);
  // A later set is limited, too.
  PatternSetContent next = set.content();
  next.version = 2;
  std::string why;
  REQUIRE(active.offer(*PatternSet::make(std::move(next), why), ExecutionTracker(1)));
  CHECK(begins("rest") < from_rest);
  active.limitSpeed(kNoLimit);
  CHECK(begins("rest") == from_rest);
  CHECK(begins("cruise") == from_cruise);
}

TEST_CASE("What few executions say of the ground is believed with less speed") {
  const GripKnowledge few{1.7, false, GripKnowledge::kSure - 1};
  const GripKnowledge many{1.7, false, GripKnowledge::kSure};
  const GripKnowledge slides{1.7, true, GripKnowledge::kSure};
  CHECK(few.stopWithin() < many.stopWithin());
  CHECK(slides.stopWithin() < few.stopWithin());
  // A set with classes of .49 and 1.08 m/s: with little experience only the slow one is used.
  const PatternSet set = twoSpeeds();
  const auto fastest = [&](int signs) {
    Rig rig;
    REQUIRE(rig.supervisor().takeSet(set));
    rig.supervisor().setGrip({1.0, false, signs});
    double speed = 0.0;
    for (int i = 0; i < 40; ++i) {
      rig.run(0.1);
      if (!rig.supervisor().program().running().empty())
        speed = std::max(speed, speedOf(set, rig.running().exit_class));
    }
    return speed;
  };
  CHECK(fastest(1) < 0.7);
  CHECK(fastest(GripKnowledge::kSure - 1) < 0.7);
  // Without experience it must start somehow.
  CHECK(fastest(0) > 1.0);
  CHECK(fastest(GripKnowledge::kSure) > 1.0);
}

TEST_CASE("Where the ground gave way a wall ahead stops the vehicle from farther away",
          "[statistics]") {
  // Largest distance of an appearing wall at which the running plan is dropped [m].
  const auto farthest = [](const GripKnowledge& grip) {
    double reach = 0.0;
    for (double distance = 0.5; distance < 2.2; distance += 0.1) {
      Rig rig;
      rig.inputs().goal->T_map_goal.x = 14.0;
      rig.run(3.2);
      REQUIRE(rig.speed() > 0.9);
      rig.supervisor().setGrip(grip);
      rig.paint(wallAt(rig.pose().x + 0.65 + distance));
      rig.run(0.1);
      if (rig.supervisor().program().running().empty()) reach = distance;
    }
    return reach;
  };
  const double usual = farthest({3.0, false});
  CHECK(usual > 0.5);
  CHECK(farthest({0.4, true}) > usual + 0.5);
}

namespace {

/// A door across the path at x = 4 m with 6 cm of space on each side.
Playground door() {
  Playground ground;
  for (const double side : {-1.0, 1.0}) ground.addWall({4.1, side * 0.5}, {4.1, side * 9.0});
  return ground;
}

Margins narrowMargins() {
  Margins margins;
  margins.check = 0.015;
  margins.narrow = 0.03;
  return margins;
}

}  // namespace

TEST_CASE("A door too narrow for the usual margin is passed with the one for narrow places") {
  const Goal goal{1, {8.0, 0.0, 0.0}, 0.5, 4.0};
  const Grid grid = door().paint(0.1, {-4.8, -9.6}, {12.8, 9.6});
  const SearchBench bench(grid, samplePatterns(), goal, narrowMargins());
  SearchProblem problem = bench.problem({0.0, 0.0, 0.0});
  const auto farthest = [&] {
    PatternSearch search{SearchConfig{}};
    double x = 0.0;
    for (const PlanStep& step : search.run(problem, after(20000)).steps) {
      x = std::max(x, step.T_map_end.x);
      CHECK(door().clearance(kVehicle, step.T_map_end) > 0.0);
    }
    return x;
  };
  CHECK(farthest() < 4.0);
  problem.little_room = true;
  CHECK(farthest() > 5.0);
}

TEST_CASE("Only where there is no plan with the usual margin one with little room is looked for") {
  const auto drive = [](const Playground& ground, double narrow) {
    PlannerConfig config = usualPlanner();
    config.map.margins = narrowMargins();
    config.map.margins.narrow = narrow;
    Rig rig(ground, config);
    double clearance = 1e9;
    for (int i = 0; i < 300; ++i) {
      rig.run(0.05);
      clearance = std::min(clearance, ground.clearance(kVehicle, rig.pose()));
    }
    CHECK(clearance > 0.0);
    return counted(rig, "plans with little room");
  };
  CHECK(drive(door(), 0.03) > 0);
  CHECK(drive(door(), 0.0) == 0);
  CHECK(drive({}, 0.03) == 0);
}

TEST_CASE("Little room is never less than the error on this ground asks for") {
  Margins margins = narrowMargins();
  margins.largest = GENERATE(0.09, 0.3);
  const CollisionChecker around(door().paint(0.1, {-4.8, -9.6}, {12.8, 9.6}), kVehicle, margins);
  CHECK(around.leastLevel({}) == CollisionChecker::kNarrow);
  for (const double sigma : {0.02, 0.05, 0.1, 0.15, 0.5}) {
    Uncertainty uncertainty;
    uncertainty.xx = uncertainty.yy = static_cast<float>(sigma * sigma);
    const int least = around.leastLevel(uncertainty);
    CAPTURE(sigma);
    CHECK((around.marginOf(least) + 1e-6 >= margins.growth * sigma ||
           least == around.level(uncertainty)));
    CHECK(least <= around.level(uncertainty));
  }
}
