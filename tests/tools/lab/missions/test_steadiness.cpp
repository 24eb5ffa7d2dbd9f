// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// What counts as dithering, and what as a stop.
#include <catch2/catch.hpp>

#include <cmath>

#include "common/pattern/pattern_file.hpp"
#include "tools/lab/missions/referee.hpp"
#include "tools/lab/missions/report.hpp"

using namespace tread;
using namespace tread::missions;

namespace {

const PatternSet& teodorPatterns() {
  static const PatternSet set =
      readPatternFile(std::string(TREAD_SOURCE_DIR) + "/config/patterns/teodor.yaml");
  return set;
}

/// Consecutive plans as published by the planner.
class Published {
 public:
  Published() { watch_.take(teodorPatterns()); }

  /// The running pattern with its execution id, and the following patterns.
  std::optional<Flip> plan(int64_t execution, const std::vector<std::string>& names) {
    plan_t plan{};
    Pose2 pose{5.0, 1.0, 0.3};
    for (const std::string& name : names) {
      const MotionPattern& pattern = *teodorPatterns().findByName(name);
      pose = pose * pattern.end();
      plan.pattern_id.push_back(pattern.id);
      plan.pose.push_back({pose.x, pose.y, pose.yaw});
      plan.execution_id.push_back(plan.execution_id.empty() ? execution : 0);
    }
    plan.num_patterns = static_cast<int32_t>(names.size());
    return watch_.hear(plan);
  }

  bool is_free = true;  ///< result for every abandoned plan
  int asked = 0;
  Pose2 asked_from;
  std::vector<std::string> asked_for;

 private:
  FlipDetector watch_{
      [this](const Pose2& start, const std::vector<const MotionPattern*>& patterns) {
        ++asked;
        asked_from = start;
        asked_for.clear();
        for (const MotionPattern* pattern : patterns) asked_for.push_back(pattern->name);
        return is_free;
      }};
};

}  // namespace

TEST_CASE("a plan that turns to the other side than the one before is a flip") {
  Published bus;
  CHECK_FALSE(bus.plan(1, {"start", "left", "straight"}));
  CHECK_FALSE(bus.plan(1, {"start", "left", "straight"}));
  const auto flip = bus.plan(1, {"start", "sharp_right", "straight"});
  REQUIRE(flip);
  CHECK(flip->from == "left");
  CHECK(flip->to == "sharp_right");
  CHECK_FALSE(bus.plan(1, {"start", "right", "left"}));
  CHECK(bus.plan(1, {"start", "straight", "left"}));
}

TEST_CASE("it is none if the plan before has become impossible, asked from where it would begin") {
  Published bus;
  bus.plan(1, {"start", "left", "straight"});
  bus.is_free = false;
  CHECK_FALSE(bus.plan(1, {"start", "right", "straight"}));
  CHECK(bus.asked == 1);
  CHECK(bus.asked_for == std::vector<std::string>{"left", "straight"});
  const Pose2 expected = Pose2{5.0, 1.0, 0.3} * teodorPatterns().findByName("start")->end();
  CHECK(std::hypot(bus.asked_from.x - expected.x, bus.asked_from.y - expected.y) < 1e-9);
}

TEST_CASE("a bend to the left and one to the right is none as long as it was planned so") {
  Published bus;
  bus.plan(1, {"start", "left", "straight", "right", "straight"});
  CHECK_FALSE(bus.plan(2, {"left", "straight", "right", "straight"}));
  CHECK_FALSE(bus.plan(3, {"straight", "right", "straight"}));
  CHECK_FALSE(bus.plan(4, {"right", "straight", "left"}));
  CHECK_FALSE(bus.plan(5, {"straight", "left"}));
  CHECK(bus.asked == 0);
}

TEST_CASE("left, straight on, right is a flip: a side stays in mind until it is driven") {
  Published bus;
  bus.plan(1, {"start", "left", "straight"});
  CHECK_FALSE(bus.plan(1, {"start", "straight", "nudge_left", "straight"}));
  CHECK(bus.plan(1, {"start", "right", "straight"}));
  CHECK_FALSE(bus.plan(2, {"right", "straight", "straight"}));
  // The bend to the right was completed: the rest is new.
  CHECK_FALSE(bus.plan(2, {"right", "straight", "left"}));
}

TEST_CASE("small corrections and turns farther off than three seconds make no side") {
  Published bus;
  bus.plan(1, {"start", "nudge_left", "straight"});
  CHECK_FALSE(bus.plan(1, {"start", "right", "straight"}));
  Published far;
  far.plan(1, {"start", "straight", "straight", "straight", "straight", "left"});
  CHECK_FALSE(far.plan(1, {"start", "right", "straight"}));
  Published near;
  near.plan(1, {"start", "straight", "straight", "left"});
  CHECK(near.plan(1, {"start", "right", "straight"}));
}

TEST_CASE("beginning another pattern than was planned is compared from its start on") {
  Published bus;
  bus.plan(1, {"turn_left_15", "turn_left_45", "start"});
  CHECK_FALSE(bus.plan(2, {"turn_left_45", "start"}));
  bus.plan(2, {"turn_left_45", "turn_left_90", "start"});
  const auto flip = bus.plan(3, {"turn_right_15", "start"});
  REQUIRE(flip);
  CHECK(flip->from == "turn_left_90");
  CHECK(std::hypot(bus.asked_from.x - 5.0, bus.asked_from.y - 1.0) < 1e-9);
}

TEST_CASE("a stop is a rest of 0.2 s after a motion, with the planner's reason or the bridge's") {
  StopDetector watch;
  int64_t now = 1'000'000;
  const auto drive = [&](double seconds, double speed, const StopReasons& said) {
    for (const int64_t end = now + std::llround(seconds * 1e6); now < end; now += 50'000)
      watch.step(now, {speed, 0.0, 0.0}, said);
  };
  drive(3.0, 0.0, {"not armed", ""});
  drive(2.0, 1.0, {"", ""});
  drive(0.15, 0.01, {"too short", ""});
  drive(1.0, 0.5, {"", ""});
  drive(0.05, 0.0, {"stopping to back up", "old"});
  drive(0.95, 0.0, {"something else", ""});
  drive(1.0, -0.5, {"", "lease expired"});
  drive(0.5, 0.0, {"", "lease expired"});
  drive(1.0, 0.5, {"", ""});
  drive(0.5, 0.0, {"", ""});
  const std::vector<Stop> stops = watch.stops(1'000'000, false);
  REQUIRE(stops.size() == 3);
  CHECK(stops[0].reason == "stopping to back up");
  CHECK(stops[0].time == Approx(6.15));
  CHECK(stops[0].duration == Approx(0.95));
  CHECK(stops[1].reason == "lease expired");
  CHECK(stops[2].reason.empty());
  CHECK(watch.stops(1'000'000, true).size() == 2);
  CHECK(watch.begun() == 4'000'000);
  CHECK(watch.driven() == Approx(5.0).margin(0.11));
}

TEST_CASE("reasons that differ in their numbers only are counted together") {
  CHECK(withoutNumbers("in 0.3 s") == "in N s");
  CHECK(withoutNumbers("MAP is 2051 ms old") == "MAP is N ms old");
  CHECK(withoutNumbers("no numbers.") == "no numbers.");
  CHECK(withoutNumbers("12.") == "N.");
  MissionResult one, two;
  one.driven = 90.0;
  one.stops = {{1.0, 0.5, "in 0.3 s"}, {2.0, 0.5, "in 0.4 s"}, {3.0, 1.0, ""}};
  one.flips = {{1.0, "left", "right"}};
  one.disarmings = {{1.0, "rolled 31 deg"}, {2.0, "rolled 32 deg"}};
  two.seed = 4;
  two.driven = 30.0;
  const Steadiness steadiness = steadinessOf({two, one});
  CHECK(steadiness.flipsPerMinute() == Approx(0.5));
  CHECK(steadiness.stops == 3);
  CHECK(steadiness.stood == Approx(2.0));
  CHECK(steadiness.reasons.at("in N s") == 2);
  CHECK(steadiness.reasons.at("") == 1);
  CHECK(steadiness.disarmed.at("rolled N deg") == 2);
}
