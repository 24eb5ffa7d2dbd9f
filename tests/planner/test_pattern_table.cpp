// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>

#include "modules/planner/core/pattern_table.hpp"
#include "modules/planner/core/prediction.hpp"
#include "tests/planner/kit/sample_patterns.hpp"

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
  const SweepStep step{0.07, 0.05};
  const PatternTable table(samplePatterns(), step, 0.05);
  for (const TablePattern& pattern : table.patterns()) {
    Pose2 last;
    for (const SweepPose& at : pattern.sweep) {
      CHECK(std::hypot(at.pose.x - last.x, at.pose.y - last.y) <= step.distance + 1e-9);
      CHECK(std::abs(at.pose.yaw - last.yaw) <= step.turn + 1e-9);
      CHECK((at.pose.position() - pattern.centre).norm() <= pattern.radius + 1e-9);
      last = at.pose;
    }
    CHECK(last.x == pattern.pattern->end().x);
    CHECK(last.yaw == pattern.pattern->end().yaw);
    CHECK(pattern.sweep.back().time == Approx(pattern.duration));
  }
}

TEST_CASE("The table knows the class of standing, what begins where, and what stops") {
  const PatternTable table(samplePatterns(), SweepStep{}, 0.05);
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

TEST_CASE("A set without a way to stop is refused in words") {
  const std::optional<PatternSet> set = without(samplePatterns(), "stop");
  REQUIRE(set);
  const PatternTable table(*set, SweepStep{}, 0.05);
  CHECK(table.defect() == "the pattern set has no pattern that stops from class cruise");
}

TEST_CASE("What is left of a pattern is laid on the measured pose") {
  const PatternTable table(samplePatterns(), SweepStep{}, 0.05);
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
  CHECK(prediction.variance == Approx(0.6 * 0.05 * 0.05));
}

TEST_CASE("Before a pattern begins the vehicle keeps the twist of its entry class") {
  const PatternTable table(samplePatterns(), SweepStep{}, 0.05);
  const TablePattern& straight = *table.find(1);
  const Prediction prediction = predict(Pose2{}, -0.1, straight, table);
  CHECK(prediction.T_map_end.x == Approx(straight.pattern->end().x + 0.11).margin(1e-6));
  CHECK(prediction.time_left == Approx(1.1));
}
