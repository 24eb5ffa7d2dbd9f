// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// How much of a deviation from the predicted velocity a vehicle keeps.
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <random>

#include "modules/learner/core/coasting.hpp"
#include "modules/learner/core/learner.hpp"
#include "tests/learner/samples.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;

namespace {

constexpr double kStep = 0.05;          // [s]
constexpr int64_t kLength = 1'000'000;  // [us] of a pattern of the small set

RuleConfig ofDefault() {
  RuleConfig config;
  config.rule = "multi_model";
  return config;
}

/// Three quarters of a measurement of the small set.
Measurement beginningOf(Measurement measurement) {
  measurement.covered = 15;
  return measurement;
}

/// Velocity in addition to the predicted one at each sample; true at the first sample of an
/// execution.
using Beside = std::function<Eigen::Vector2d(bool begins)>;

/// Mean distances of measured ends from the set published during the previous pattern, and from the
/// rule's own prediction at that time; over the second half.
struct Errors {
  double published = 0.0;
  double of_rule = 0.0;
};

Errors driveOn(const Beside& beside, int executions) {
  Learner learner(ofDefault(), smallSet());
  std::mt19937_64 random(3);
  const std::vector<int> ids{kStraight, kLeft, kRight};
  const std::vector<Twist2> twists{{1.0, 0.0, 0.0}, {0.9, 0.0, 0.5}, {0.9, 0.0, -0.5}};
  Errors errors;
  std::optional<PatternSet> published;
  std::vector<Pose2> of_rule;
  for (int n = 0; n < executions; ++n) {
    const size_t choice = random() % ids.size();
    const int id = ids[choice];
    std::vector<Pose2> driven;
    Pose2 pose;
    for (int t = 0; t < 20; ++t) {
      const Eigen::Vector2d more = beside(t == 0);
      const Twist2& usual = twists[choice];
      pose = pose * integrate({usual.v_x + more[0], usual.v_y + more[1], usual.omega}, kStep);
      driven.push_back(pose);
    }
    if (published && 2 * n >= executions) {
      const auto distance = [&](const Pose2& end) {
        return std::hypot(pose.x - end.x, pose.y - end.y) / (0.5 * executions);
      };
      errors.published += distance(published->find(id)->end());
      errors.of_rule += distance(of_rule[choice]);
    }
    const int64_t ended = (n + 1) * kLength;
    REQUIRE(learner.follow(id, beginningOf(fair(driven)), 4, ended - kLength / 4));
    published = learner.set();
    of_rule.clear();
    for (size_t p = 0; p < ids.size(); ++p) of_rule.push_back(learner.rule().predictEnd(p));
    REQUIRE(learner.learn(id, fair(driven), {}, ended).changed);
  }
  return errors;
}

}  // namespace

TEST_CASE("a vehicle that coasts is expected where it coasts to") {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
  // It changes by 0.15 m/s within two seconds.
  const Errors errors = driveOn(
      [&](bool) {
        const double kept = std::exp(-kStep / 2.0);
        const double kick = 0.15 * std::sqrt(1.0 - kept * kept);
        velocity = kept * velocity + kick * Eigen::Vector2d(normal(random), normal(random));
        return velocity;
      },
      200);
  CAPTURE(errors.published, errors.of_rule);
  CHECK(errors.published < 0.85 * errors.of_rule);
}

TEST_CASE("where no execution tells of the next one, coasting is unlearned") {
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal;
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
  const Errors errors = driveOn(
      [&](bool begins) {
        if (begins) velocity = 0.1 * Eigen::Vector2d(normal(random), normal(random));
        return velocity;
      },
      200);
  CAPTURE(errors.published, errors.of_rule);
  CHECK(errors.published < 1.03 * errors.of_rule);
}

TEST_CASE("what is published between executions is what the rule says") {
  Learner learner(ofDefault(), smallSet());
  const auto faster = fair(arc({1.2, 0.0, 0.0}));
  REQUIRE(learner.follow(kStraight, beginningOf(faster), 4, kLength - kLength / 4));
  CHECK(learner.set().find(kLeft)->end().x > learner.rule().predictEnd(1).x + 0.01);
  REQUIRE(learner.learn(kStraight, faster, {}, kLength).changed);
  for (size_t p = 0; p < learner.set().patterns().size(); ++p)
    CHECK(learner.set().patterns()[p].end().x == learner.rule().predictEnd(p).x);
}

TEST_CASE("only patterns that may follow begin with what is kept, and none from rest") {
  PatternSetContent content = smallContent();
  content.classes.push_back({"rest", {}, {0.0, 0.0}});
  content.patterns[1].exit_class = "rest";
  content.patterns[2].entry_class = "rest";
  Learner learner(ofDefault(), checked(std::move(content)));
  const auto shiftOf = [&](size_t p) {
    return learner.set().patterns()[p].end().x - learner.rule().predictEnd(p).x;
  };
  const Measurement beginning = beginningOf(fair(arc({1.2, 0.0, 0.0})));
  REQUIRE(learner.follow(kStraight, beginning, 4, kLength - kLength / 4));
  CHECK(shiftOf(0) > 0.01);
  CHECK(shiftOf(1) > 0.01);
  CHECK(shiftOf(2) == 0.0);
  REQUIRE(learner.unfollow(kLength));
  REQUIRE(learner.follow(kLeft, beginning, 4, 2 * kLength));
  for (size_t p = 0; p < learner.set().patterns().size(); ++p) CHECK(shiftOf(p) == 0.0);
}

TEST_CASE("executions after a pause tell nothing of coasting") {
  Learner learner(ofDefault(), smallSet());
  const auto faster = fair(arc({1.2, 0.0, 0.0}));
  // The rule's numbers are followed by two sums, then the end of the last execution and its d.
  const auto sumsOf = [](const Learner& of) {
    const std::vector<double> memory = of.memory();
    return std::vector<double>(memory.end() - 5, memory.end() - 3);
  };
  const std::vector<double> none{0.0, 0.0};
  REQUIRE(learner.learn(kStraight, faster, {}, kLength).changed);
  CHECK(sumsOf(learner) == none);
  REQUIRE(learner.learn(kStraight, faster, {}, 3 * kLength).changed);
  CHECK(sumsOf(learner) == none);
  REQUIRE(learner.learn(kLeft, fair(arc({1.0, 0.0, 0.5})), {}, 4 * kLength).changed);
  CHECK(sumsOf(learner)[1] > 0.0);
}

TEST_CASE("a restored learner goes on as if it had never ended") {
  Learner learner(ofDefault(), smallSet());
  const auto faster = fair(arc({1.2, 0.0, 0.0}));
  for (int n = 1; n <= 3; ++n) REQUIRE(learner.learn(kStraight, faster, {}, n * kLength).changed);
  Learner restored(ofDefault(), smallSet());
  REQUIRE(restored.restore(learner.set(), learner.residuals(), learner.memory()));
  REQUIRE(restored.memory() == learner.memory());
  for (Learner* each : {&learner, &restored}) {
    REQUIRE(each->learn(kLeft, fair(arc({1.0, 0.0, 0.5})), {}, 4 * kLength).changed);
    REQUIRE(each->follow(kStraight, beginningOf(faster), 3, 5 * kLength - kLength / 4));
  }
  CHECK(restored.set().checksum() == learner.set().checksum());
  CHECK(restored.memory() == learner.memory());
}

TEST_CASE("a set that is renumbered while a pattern runs is that of the last end") {
  Learner learner(ofDefault(), smallSet());
  REQUIRE(learner.follow(kStraight, beginningOf(fair(arc({1.2, 0.0, 0.0}))), 4, kLength));
  REQUIRE(learner.set().find(kStraight)->end().x > 1.01);
  learner.renumber(1000, 1);
  CHECK(learner.set().version() == 1000);
  CHECK(learner.set().find(kStraight)->end().x == Approx(1.0));
  CHECK_FALSE(learner.unfollow(kLength));
}

TEST_CASE("coasting is learned from what follows, and kept within what a vehicle can do") {
  Coasting coasting(1.0);
  CHECK(coasting.tau() == Approx(0.2));
  const double share = 1.0 - std::exp(-2.0);
  for (int i = 0; i < 100; ++i)
    coasting.learn({0.1, -0.1}, Eigen::Vector2d(0.04, -0.04) * share, 1.0);
  CHECK(coasting.tau() == Approx(0.4).epsilon(0.1));
  std::vector<Pose2> poses = arc({1.0, 0.0, 0.0});
  coasting.add({0.1, 0.05}, kStep, poses);
  CHECK(poses.back().x == Approx(1.0 + share * 0.1 * coasting.tau()));
  CHECK(poses.back().y == Approx(share * 0.05 * coasting.tau()));
  CHECK(poses.front().y < 0.15 * poses.back().y);
  for (int i = 0; i < 1000; ++i) coasting.learn({0.1, 0.0}, {-1.0, 0.0}, 1.0);
  CHECK(coasting.tau() == 0.0);
  for (int i = 0; i < 1000; ++i) coasting.learn({0.1, 0.0}, {5.0, 0.0}, 1.0);
  CHECK(coasting.tau() == 1.0);
  CHECK(Coasting(0.0).tau() == Approx(0.2));  // a set without motion
  // Values that are not finite have no effect.
  coasting.learn({testing::kNan, 0.0}, {0.0, 0.0}, 1.0);
  coasting.learn({0.1, 0.0}, {testing::kNan, 0.0}, 1.0);
  CHECK(coasting.tau() == 1.0);
}

TEST_CASE("a velocity beside the predicted one is measured in the body frame, at the end") {
  const Coasting coasting(1.0);
  // Rotated by 90 degrees, sliding to the left: along the old x axis it moves backwards.
  const std::vector<Pose2> predicted = arc({0.5, 0.0, M_PI_2});
  const std::vector<Pose2> measured = arc({0.5, 0.2, M_PI_2});
  const auto beside = coasting.beside(measured, predicted, 20, kStep);
  REQUIRE(beside);
  CHECK((*beside)[0] == Approx(0.0).margin(0.05));
  CHECK((*beside)[1] == Approx(0.2).margin(0.02));
  CHECK_FALSE(coasting.beside(measured, predicted, 4, kStep));
  CHECK_FALSE(coasting.beside(measured, arc({0.5, 0.0, 0.0}, 5), 20, kStep));
  // A different yaw rate is not a sideways velocity.
  const auto turned = coasting.beside(arc({1.0, 0.0, 0.6}), arc({1.0, 0.0, 1.2}), 20, kStep);
  REQUIRE(turned);
  CHECK(turned->norm() < 0.005);
  // At most half of the fastest velocity is accepted.
  const auto thrown = coasting.beside(arc({9.0, 0.0, 0.0}), predicted, 20, kStep);
  REQUIRE(thrown);
  CHECK(thrown->cwiseAbs().maxCoeff() == Approx(0.5));
  CHECK_FALSE(coasting.beside(arc({testing::kNan, 0.0, 0.0}), predicted, 20, kStep));
}
