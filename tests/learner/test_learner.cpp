// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include "modules/learner/core/learner.hpp"
#include "tests/learner/samples.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;

namespace {

RuleConfig config(Rule rule, double memory = 0.3) {
  RuleConfig made;
  made.rule = rule;
  made.memory = memory;
  return made;
}

double endDistance(const Pose2& a, const Pose2& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

bool sameTrajectory(const PatternSet& a, const PatternSet& b, int id) {
  const auto& first = a.find(id)->trajectory;
  const auto& second = b.find(id)->trajectory;
  for (size_t t = 0; t < first.size(); ++t)
    if (first[t].x != second[t].x || first[t].y != second[t].y || first[t].yaw != second[t].yaw)
      return false;
  return true;
}

/// The left turn with scaled poses.
Measurement scaledLeft(double x, double y, double yaw) {
  auto trajectory = arc({0.9, 0.0, 0.5});
  for (Pose2& pose : trajectory) pose = {pose.x * x, pose.y * y, pose.yaw * yaw};
  return fair(trajectory);
}

}  // namespace

TEST_CASE("off never changes the set, whatever is measured") {
  Learner learner(config("off"), smallSet());
  const int64_t before = learner.set().checksum();
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> any(-1.5, 1.5);
  for (int i = 0; i < 200; ++i) {
    const auto measurement = fair(arc({any(random), 0.2 * any(random), any(random)}));
    const Correction correction =
        learner.learn(1 + i % 5, measurement, Pose2{any(random), 0.0, 0.0}, i);
    REQUIRE_FALSE(correction.changed);
  }
  REQUIRE(learner.set().checksum() == before);
}

TEST_CASE("single smooths the executed pattern and leaves the others") {
  Learner learner(config("single"), smallSet());
  const PatternSet before = learner.set();
  const auto measured = arc({0.8, 0.0, 0.6});
  REQUIRE(learner.learn(kLeft, fair(measured), {}, 77).changed);
  const Pose2 end = learner.set().find(kLeft)->end();
  REQUIRE(end.x == Approx(0.7 * measured.back().x + 0.3 * before.find(kLeft)->end().x));
  REQUIRE(end.y == Approx(0.7 * measured.back().y + 0.3 * before.find(kLeft)->end().y));
  REQUIRE(end.yaw == Approx(0.7 * 0.6 + 0.3 * 0.5));
  for (const int id : {kStraight, kRight, kSpin, kReverse})
    REQUIRE(sameTrajectory(learner.set(), before, id));
  REQUIRE(learner.set().find(kLeft)->times_learned == 1);
  REQUIRE(learner.set().find(kRight)->times_learned == 0);
}

TEST_CASE("collective scales all others by V and smooths them: Algorithm 1 with memory 0.3") {
  Learner learner(config("collective"), smallSet());
  const PatternSet before = learner.set();
  const Correction correction = learner.learn(kLeft, scaledLeft(0.9, 1.2, 1.4), {}, 77);
  REQUIRE(correction.note.scaling[0] == Approx(0.9));
  REQUIRE(correction.note.scaling[1] == Approx(1.2));
  REQUIRE(correction.note.scaling[2] == Approx(1.4));
  // (1 - w) R V + w R: factors 0.7 * 0.9 + 0.3 and so on.
  const Pose2 right = learner.set().find(kRight)->end();
  const Pose2 right_before = before.find(kRight)->end();
  REQUIRE(right.x == Approx(0.93 * right_before.x));
  REQUIRE(right.y == Approx(1.14 * right_before.y));
  REQUIRE(right.yaw == Approx(1.28 * right_before.yaw));
  // One-dimensional patterns are scaled along their existing axes.
  REQUIRE(learner.set().find(kStraight)->end().x == Approx(0.93));
  REQUIRE(learner.set().find(kStraight)->end().yaw == 0.0);
  REQUIRE(learner.set().find(kSpin)->end().yaw == Approx(1.28 * 1.2));
  REQUIRE(learner.set().find(kReverse)->end().x == Approx(0.93 * -0.8));
  // The executed pattern gets its own measurement instead of V.
  REQUIRE(learner.set().find(kLeft)->end().yaw == Approx((0.7 * 1.4 + 0.3) * 0.5));
}

TEST_CASE("a one-dimensional pattern updates only itself") {
  for (const int id : {kStraight, kSpin, kReverse}) {
    Learner learner(config("collective"), smallSet());
    const PatternSet before = learner.set();
    auto trajectory = before.find(id)->trajectory;
    for (Pose2& pose : trajectory) pose = {0.8 * pose.x, pose.y + 0.01, 0.8 * pose.yaw};
    const Correction correction = learner.learn(id, fair(trajectory), {}, 1);
    REQUIRE(correction.changed);
    REQUIRE(std::isnan(correction.note.scaling[0]));
    REQUIRE(correction.guards.find("one-dimensional") != std::string::npos);
    for (const MotionPattern& other : before.patterns())
      REQUIRE(sameTrajectory(learner.set(), before, other.id) == (other.id != id));
  }
}

TEST_CASE("a turn to the other side beyond the noise updates only itself and is flagged") {
  Learner learner(config("collective"), smallSet());
  const PatternSet before = learner.set();
  const Correction correction = learner.learn(kLeft, fair(arc({0.9, 0.0, -0.4})), {}, 1);
  REQUIRE(correction.changed);
  REQUIRE(std::isnan(correction.note.scaling[2]));
  REQUIRE(correction.guards.find("turned in the opposite direction") != std::string::npos);
  REQUIRE(sameTrajectory(learner.set(), before, kRight));
  REQUIRE_FALSE(sameTrajectory(learner.set(), before, kLeft));
}

TEST_CASE("motion backwards instead of forwards gives no V") {
  Learner learner(config("collective"), smallSet());
  const Correction correction = learner.learn(kLeft, fair(arc({-0.5, 0.0, 0.5})), {}, 1);
  REQUIRE(correction.guards.find("moved in the opposite direction") != std::string::npos);
  REQUIRE(std::isnan(correction.note.scaling[0]));
}

TEST_CASE("an opposite sign within the noise still gives V") {
  PatternSetContent content = smallContent();
  // A weak left turn of 0.06 rad; three sigma without recordings are 0.074 rad.
  content.patterns[1].trajectory = arc({0.9, 0.05, 0.06});
  Learner learner(config("collective"), checked(content));
  REQUIRE(
      std::isfinite(learner.learn(kLeft, fair(arc({0.9, 0.05, -0.01})), {}, 1).note.scaling[0]));
  REQUIRE(std::isnan(learner.learn(kLeft, fair(arc({0.9, 0.05, -0.5})), {}, 2).note.scaling[0]));
}

TEST_CASE("patterns without a usable axis stay as they are") {
  PatternSetContent content = smallContent();
  content.patterns.push_back(pattern(6, "creep", {0.1, 0.1}, arc({0.03, 0.0, 0.01})));
  Learner learner(config("collective"), checked(content));
  const PatternSet before = learner.set();
  REQUIRE(learner.learn(kLeft, scaledLeft(0.8, 0.8, 0.8), {}, 1).changed);
  REQUIRE(sameTrajectory(learner.set(), before, 6));
}

TEST_CASE("what is usable is decided once: a scaled set does not fall below the thresholds later") {
  PatternSetContent content = smallContent();
  // Initially 0.12 rad: after a few halvings its yaw interval is below both yaw limits.
  content.patterns[2].trajectory = arc({0.9, -0.1, -0.12});
  Learner learner(config("collective", 0.0), checked(content));
  for (int i = 0; i < 4; ++i) {
    const double yaw_before = learner.set().find(kRight)->end().yaw;
    auto measured = learner.set().find(kLeft)->trajectory;
    for (Pose2& pose : measured) pose.yaw *= 0.6;
    REQUIRE(learner.learn(kLeft, fair(measured), {}, i).changed);
    REQUIRE(learner.set().find(kRight)->end().yaw == Approx(0.6 * yaw_before));
  }
  REQUIRE(std::abs(learner.set().find(kRight)->end().yaw) < 0.03);
}

TEST_CASE("each accepted change is a new version with its parent and the time of the measurement") {
  Learner learner(config("single"), smallSet());
  for (int64_t i = 1; i <= 5; ++i) {
    learner.learn(kLeft, fair(arc({0.8, 0.0, 0.6})), {}, 100 * i);
    REQUIRE(learner.set().version() == 1 + i);
    REQUIRE(learner.set().content().parent_version == i);
    REQUIRE(learner.set().content().utime == 100 * i);
  }
}

TEST_CASE("structure of the paper's column b: left, left, right errs by (2 a + b2) / 3") {
  const auto truth_left = arc({0.8, 0.0, 0.7});
  const auto truth_right = arc({0.8, 0.0, -0.7});
  Learner learner(config("single"), smallSet());
  const auto error = [&](int id, const std::vector<Pose2>& truth) {
    return endDistance(truth.back(), learner.set().find(id)->end());
  };
  const double a = error(kLeft, truth_left);
  double sum = a;
  learner.learn(kLeft, fair(truth_left), {}, 1);
  const double b2 = error(kLeft, truth_left);
  sum += b2;
  learner.learn(kLeft, fair(truth_left), {}, 2);
  sum += error(kRight, truth_right);
  REQUIRE(b2 == Approx(0.3 * a));
  REQUIRE(sum / 3.0 == Approx((2.0 * a + b2) / 3.0));
}

TEST_CASE("with a memory of zero the measurement replaces the prediction") {
  Learner learner(config("single", 0.0), smallSet());
  learner.learn(kLeft, fair(arc({0.8, 0.0, 0.7})), {}, 1);
  REQUIRE(learner.set().find(kLeft)->end().yaw == Approx(0.7));
}

TEST_CASE("a memory of one or more is refused at the start") {
  REQUIRE_THROWS_WITH(Learner(config("single", 1.0), smallSet()), Catch::Contains("memory"));
}

TEST_CASE("a correction that would make a wrong set is not taken") {
  Learner learner(config("single", 0.0), smallSet());
  auto jumping = arc({0.9, 0.0, 0.5});
  jumping[10].x += 5.0;  // 100 m/s for one period
  const Correction correction = learner.learn(kLeft, fair(jumping), {}, 1);
  REQUIRE_FALSE(correction.changed);
  REQUIRE(correction.guards.find("set would be wrong") != std::string::npos);
  REQUIRE(learner.set().version() == 1);
}

TEST_CASE("the end covariance is unknown until three errors are known, then their mean square") {
  Learner learner(config("single"), smallSet());
  const auto measurement = fair(arc({0.9, 0.0, 0.5}));
  for (const double x : {0.1, -0.2, 0.3}) {
    REQUIRE(std::isnan(learner.set().find(kLeft)->end_covariance[0]));
    learner.learn(kLeft, measurement, Pose2{x, 0.1, 0.0}, 1);
  }
  const PoseCovariance& known = learner.set().find(kLeft)->end_covariance;
  REQUIRE(known[0] == Approx(0.14 / 3.0));
  REQUIRE(known[1] == Approx(0.02 / 3.0));
  REQUIRE(known[3] == Approx(0.01));
  REQUIRE(known[5] == Approx(0.0).margin(1e-12));
  REQUIRE(std::isnan(learner.set().find(kRight)->end_covariance[0]));
}

TEST_CASE("a shipped covariance is where the observed one starts, and old errors fade") {
  MotionPattern left = smallContent().patterns[1];
  left.end_covariance = {0.01, 0.0, 0.0, 0.01, 0.0, 0.01};
  EndResiduals residuals = residualsOf(left);
  REQUIRE(covarianceOf(residuals)[0] == 0.01);
  addResidual(residuals, {0.4, 0.0, 0.0});
  REQUIRE(residuals.mean[0] == Approx((5.0 * 0.01 + 0.16) / 6.0));
  for (int i = 0; i < 100; ++i) addResidual(residuals, {0.0, 0.0, 0.0});
  REQUIRE(residuals.mean[0] < 1e-5);
}

TEST_CASE("an end that was not measured adds nothing to the covariance") {
  Learner learner(config("single"), smallSet());
  for (int i = 0; i < 10; ++i) learner.learn(kLeft, fair(arc({0.8, 0.0, 0.5})), {}, 1);
  REQUIRE(std::isnan(learner.set().find(kLeft)->end_covariance[0]));
}

TEST_CASE("a shipped covariance without spread in one axis is still one, without any it is none") {
  MotionPattern straight = smallContent().patterns[0];
  straight.end_covariance = {7e-4, 0.0, 0.0, 1e-3, 0.0, 0.0};
  REQUIRE(residualsOf(straight).count == 5);
  straight.end_covariance.fill(0.0);
  REQUIRE(residualsOf(straight).count == 0);
}
