// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>

#include "common/pattern/pattern_file.hpp"
#include "modules/planner/core/execution/driving_state.hpp"
#include "modules/planner/core/map/collision_checker.hpp"
#include "modules/planner/core/search/swept_footprint.hpp"
#include "tests/planner/kit/playground.hpp"
#include "tests/planner/kit/sample_patterns.hpp"
#include "tests/planner/kit/vehicle.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

std::optional<PatternSet> without(const PatternSet& set, const std::string& name) {
  PatternSetContent content = set.content();
  auto& patterns = content.patterns;
  for (size_t i = 0; i < patterns.size(); ++i)
    if (patterns[i].name == name) patterns.erase(patterns.begin() + static_cast<long>(i--));
  std::string why;
  return PatternSet::make(std::move(content), why);
}

}  // namespace

TEST_CASE("Poses to check are nowhere farther apart than the step and end at the pattern's end") {
  const SweepResolution step{0.07, 0.05, 0.3, kVehicle.widened(0.09)};
  const PatternTable table(samplePatterns(), step, {});
  for (const TablePattern& pattern : table.patterns()) {
    Pose2 last;
    for (const SweptPose& at : pattern.swept_poses) {
      CHECK(std::hypot(at.pose.x - last.x, at.pose.y - last.y) <= step.distance + 1e-9);
      CHECK(std::abs(at.pose.yaw - last.yaw) <= step.turn + 1e-9);
      CHECK((at.pose.position() - pattern.centre).norm() <= pattern.radius + 1e-9);
      last = at.pose;
    }
    CHECK(last.x == pattern.pattern->end().x);
    CHECK(last.yaw == pattern.pattern->end().yaw);
    CHECK(pattern.swept_poses.back().time == Approx(pattern.duration));
  }
}

TEST_CASE("The table knows the class of standing, what begins where, and what stops") {
  const PatternTable table(samplePatterns(), usualSweep(), {});
  REQUIRE(table.restClass() >= 0);
  CHECK(table.motionClass(table.restClass()).name == "rest");
  for (int i = 0; i < table.classCount(); ++i)
    for (const TablePattern* pattern : table.from(i)) CHECK(pattern->entry == i);
  const int cruise = table.classIndex("cruise");
  REQUIRE(table.stopsFrom(cruise).size() == 1);
  CHECK(table.stopsFrom(cruise).front()->pattern->name == "stop");
  CHECK(table.bestSpeed() == Approx(1.1).epsilon(0.01));
  CHECK(table.defect().empty());
}

TEST_CASE("How far ahead is planned follows from how long the set's patterns are") {
  const auto usual = [](const std::string& file) {
    const PatternSet set = readPatternFile(std::string(TREAD_SOURCE_DIR) + file);
    return PatternTable(set, usualSweep(), {}).usualDuration();
  };
  CHECK(usual("/config/patterns/teodor.yaml") == Approx(1.5));
  CHECK(usual("/tests/data/robots/jackal/patterns.yaml") == Approx(0.7));
  // If all patterns begin and end at rest, all are counted.
  CHECK(PatternTable(latticePatterns(), usualSweep(), {}).usualDuration() == Approx(1.0));
}

TEST_CASE("A set without a way to stop is refused in words") {
  const std::optional<PatternSet> set = without(samplePatterns(), "stop");
  REQUIRE(set);
  const PatternTable table(*set, usualSweep(), {});
  CHECK(table.defect() == "the pattern set has no pattern that stops from class cruise");
}

TEST_CASE("What is left of a pattern is laid on the measured pose") {
  const PatternTable table(samplePatterns(), usualSweep(), {});
  const TablePattern& left = *table.find(3);
  REQUIRE(left.pattern->name == "left");
  const Pose2 start{3.0, -2.0, 1.0};
  const double period = table.set().periodSeconds();
  const Pose2 now = start * poseAlong(left.pattern->trajectory, period, 0.4);
  const Prediction prediction = predict(now, 0.4, left, table);
  const Pose2 end = start * left.pattern->end();
  CHECK(prediction.T_map_end.x == Approx(end.x).margin(1e-9));
  CHECK(prediction.T_map_end.y == Approx(end.y).margin(1e-9));
  CHECK(prediction.T_map_end.yaw == Approx(end.yaw).margin(1e-9));
  CHECK(prediction.time_left == Approx(0.6));
  for (const ExpectedPose& at : prediction.ahead) CHECK(at.time > 0.0);
  CHECK(prediction.uncertainty.xx == Approx(0.6 * 0.05 * 0.05));
}

TEST_CASE("Before a pattern begins the vehicle keeps the twist of its entry class") {
  const PatternTable table(samplePatterns(), usualSweep(), {});
  const TablePattern& straight = *table.find(1);
  const Prediction prediction = predict(Pose2{}, -0.1, straight, table);
  CHECK(prediction.T_map_end.x == Approx(straight.pattern->end().x + 0.11).margin(1e-6));
  CHECK(prediction.time_left == Approx(1.1));
}

TEST_CASE("What is left of a running pattern is scaled by how much of it has come true") {
  const PatternTable table(samplePatterns(), usualSweep(), {});
  const double period = table.set().periodSeconds();
  for (const TablePattern& pattern : table.patterns()) {
    const double half = pattern.duration / 2.0;
    const Pose2 expected = poseAlong(pattern.pattern->trajectory, period, half);
    const MotionRatio as_promised = motionRatio(expected, half, pattern, period);
    CHECK(as_promised.way == Approx(1.0));
    CHECK(as_promised.turn == Approx(1.0));
    const Prediction plain = predict(expected, half, pattern, table);
    CHECK(plain.T_map_end.yaw == Approx(pattern.end().pose.yaw).margin(1e-9));
    CHECK(plain.T_map_end.x == Approx(pattern.end().pose.x).margin(1e-9));
    // Ground on which the vehicle turns 1.5 times as far is expected to continue, minus the
    // uncertainty.
    const MotionRatio more =
        motionRatio({expected.x, expected.y, 1.5 * expected.yaw}, half, pattern, period);
    CHECK(more.turn >= 1.0);
    CHECK(more.turn <= 1.5);
    const double rest_of_turn = pattern.end().pose.yaw - expected.yaw;
    const Prediction wider = predict(expected, half, pattern, table, more);
    CHECK(wider.T_map_end.yaw - expected.yaw == Approx(more.turn * rest_of_turn).margin(1e-9));
  }
}

TEST_CASE("A start without margin may go on only where room is gained") {
  // A wall along the vehicle's left side, 1 cm from its outline.
  const FootprintSize body = kVehicle;
  Playground ground;
  ground.addWall({-3.0, body.half_width + 0.12}, {5.0, body.half_width + 0.12}, 0.2);
  const CollisionChecker around(ground.paint(0.01, {-3.0, -3.0}, {5.0, 3.0}), body, Margins{});
  const Pose2 start{0.0, 0.0, 0.0};
  const int level = around.freeLevel(start, CollisionChecker::kPlan);
  REQUIRE(level >= CollisionChecker::kBare);
  REQUIRE(level < CollisionChecker::kCheck);
  const PatternTable table(samplePatterns(), usualSweep(), {});
  int along = 0;
  int away = 0;
  for (const TablePattern& pattern : table.patterns()) {
    const Pose2& end = pattern.end().pose;
    const bool regains =
        around.sweepRegains(turned(start), level, pattern, CollisionChecker::kPlan);
    if (std::abs(end.x) > 0.9 && std::abs(end.y) < 0.01) {
      ++along;
      // no contact, but no increase of the distance
      CHECK(around.sweepFree(start, pattern, level));
      CHECK_FALSE(regains);
    }
    if (regains) {
      ++away;
      CHECK(around.sweepFree(start, pattern, level));
      if (pattern.end().reach > 0.25) CHECK(around.freeLevel(end, CollisionChecker::kPlan) > level);
    }
  }
  CHECK(along > 0);
  CHECK(away > 0);
}
