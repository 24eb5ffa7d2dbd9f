// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The first moments of sliding on slippery ground.
#include <cmath>

#include <catch2/catch.hpp>

#include "modules/planner/core/execution/slide.hpp"
#include "tests/planner/kit/policy_rig.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

constexpr double kGives = 0.8;  // [m/s2]

Playground acrossAt(double x, double from = -9.0) {
  Playground ground;
  ground.addWall({x + 0.1, from}, {x + 0.1, 9.0});
  return ground;
}

CollisionChecker checkerOf(const Playground& ground) {
  return CollisionChecker(ground.paint(0.05, {-4.8, -9.6}, {12.8, 9.6}), kVehicle, {});
}

Sliding at(double speed) {
  return {{0.0, 0.0, 0.0}, {speed, 0.0}, kGives};
}

}  // namespace

TEST_CASE(
    "What goes sideways or on where its pattern does not, slides, and what is slow does not") {
  const Twist2 straight{1.0, 0.0, 0.0};
  CHECK_FALSE(slides({1.05, 0.03, 0.1}, straight));
  CHECK(slides({1.0, 0.4, 0.1}, straight));
  CHECK(slides({1.0, 0.0, 0.0}, {0.5, 0.0, 0.0}));
  CHECK_FALSE(slides({0.4, 0.0, 0.0}, straight));
  CHECK_FALSE(slides({0.1, 0.5, 0.0}, {0.0, 0.5, 0.0}));  // intended sideways motion
}

TEST_CASE(
    "A stop on ice ends before a wall that is far enough, and touches a near one as slowly "
    "as the ground has slowed it down") {
  const double way = 2.0 * 2.0 / (2.0 * kGives);
  CHECK(impactSpeed(checkerOf(acrossAt(way + kVehicle.front + 0.3)), at(2.0), {}) == 0.0);
  const double near = 1.0;
  CHECK(impactSpeed(checkerOf(acrossAt(near + kVehicle.front)), at(2.0), {}) ==
        Approx(std::sqrt(4.0 - 2.0 * kGives * near)).margin(0.15));
}

TEST_CASE("A vehicle that slides beside a wall's end gets past it by steering, not by a stop") {
  // The wall reaches 5 cm into its path.
  const CollisionChecker around =
      checkerOf(acrossAt(1.5 + kVehicle.front, kVehicle.half_width - 0.05));
  CHECK(impactSpeed(around, at(2.0), {}) > 0.5);
  CHECK(impactSpeed(around, at(2.0), {{{2.0, -2.0, 0.0}, 2.0}}) == 0.0);
}

TEST_CASE("The answer to a slide is what touches nothing, or else most slowly") {
  const PatternTable table(samplePatterns(), {}, {});
  const double period = table.set().periodSeconds();
  SlideChoices choices;
  choices.rest = {{{2.0, 0.0, 0.0}, 0.2}};
  choices.next = table.find(table.set().findByName("straight")->id);
  const auto answer = [&](const Playground& ground) {
    return answerToSlide(checkerOf(ground), at(2.0), choices, period);
  };
  CHECK(answer({}).kind == SlideAnswer::Kind::kGoOn);
  const double way = 2.0 * 2.0 / (2.0 * kGives);
  const SlideAnswer stop = answer(acrossAt(way + kVehicle.front + 0.1));
  CHECK(stop.kind == SlideAnswer::Kind::kStop);
  CHECK(stop.impact == 0.0);
  const SlideAnswer crash = answer(acrossAt(0.6 + kVehicle.front));
  CHECK(crash.kind == SlideAnswer::Kind::kStop);
  CHECK(crash.impact > 1.5);
  // Another pattern is used if it avoids the contact of a stop.
  MotionPattern aside = *table.set().findByName("straight");
  for (Pose2& pose : aside.trajectory) pose = {0.3 * pose.x, -2.0 * pose.x, 0.0};
  TablePattern follower = *choices.next;
  follower.pattern = &aside;
  choices.followers = {&follower};
  const SlideAnswer steered = answer(acrossAt(1.5 + kVehicle.front, kVehicle.half_width - 0.02));
  CHECK(steered.kind == SlideAnswer::Kind::kFollow);
  CHECK(steered.impact == 0.0);
}

TEST_CASE("In the rest of a pattern is asked what its trajectory says") {
  const PatternSet set = samplePatterns();
  const MotionPattern& straight = *set.findByName("straight");
  const double whole = set.periodSeconds() * static_cast<double>(straight.trajectory.size());
  const std::vector<AskedMotion> rest = askedFrom(straight, set.periodSeconds(), 0.5 * whole);
  double seconds = 0.0;
  for (const AskedMotion& motion : rest) {
    seconds += motion.seconds;
    CHECK(motion.v_body.v_x == Approx(set.classNamed("cruise").twist.v_x).epsilon(0.1));
  }
  CHECK(seconds == Approx(0.5 * whole));
  CHECK(askedFrom(straight, set.periodSeconds(), whole).empty());
}

TEST_CASE("A slide towards a wall is answered at once, one on free ground is not") {
  const bool wall = GENERATE(true, false);
  Rig rig;
  rig.inputs().goal->T_map_goal.x = 14.0;
  rig.run(3.2);
  REQUIRE(rig.speed() > 0.9);
  // Farther than the stop on firm ground, nearer than that on ice.
  if (wall) rig.paint(acrossAt(rig.pose().x + kVehicle.front + 0.45));
  const auto sliding = [](PlannerInputs& seen) { seen.pose->twist = Twist2{1.0, 0.5, 0.0}; };
  rig.run(0.1, sliding);
  CHECK(rig.supervisor().program().running().empty() == wall);
}
