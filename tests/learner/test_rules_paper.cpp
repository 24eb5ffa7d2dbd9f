// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Behaviour of the paper's rules and their failures: plateau, drift, strong turns, bounds.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>

#include "common/vehicle/kernel.hpp"
#include "modules/learner/core/scaling.hpp"
#include "tests/helpers.hpp"
#include "tests/learner/rule_bench.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;
using tread::testing::effort;

namespace {

constexpr double kPeriodS = 0.05;
constexpr size_t kExecutions = 20;

/// Teodor on a surface (config/models).
VehicleModel teodor(double forward_gain, double yaw_gain, double lever, ExecutionSpread spread) {
  VehicleModel model;
  model.full_speed = 1.1;
  model.gauge = 0.6;
  model.lag = 0.15;
  model.forward_gain = forward_gain;
  model.yaw_gain = yaw_gain;
  model.effects.icr_offset = -lever;
  model.spread = spread;
  return model;
}

VehicleModel cinder() {
  return teodor(0.9535, 0.8896, 0.0226, {0.0149, 0.0373, 0.0474});
}

VehicleModel grass() {
  return teodor(1.046, 1.223, -0.1003, {0.0418, 0.0831, 0.0147});
}

/// A second of the command, half a second of cruise.
std::vector<TrackCommand> turning(double left, double right) {
  std::vector<TrackCommand> commands(20, {left, right});
  commands.insert(commands.end(), 10, {1.0, 1.0});
  return commands;
}

/// Simulated executions of the same patterns on one surface, and their average as a set.
class Recording {
 public:
  Recording(const VehicleModel& model, const std::vector<std::vector<TrackCommand>>& patterns,
            uint64_t seed)
      : set_(smallSet()) {
    std::mt19937_64 random(seed);
    const EntryState cruise = steadyEntry(model, {1.0, 1.0});
    for (const auto& commands : patterns) {
      executions_.emplace_back();
      for (size_t i = 0; i < kExecutions; ++i)
        executions_.back().push_back(
            simulate(model, commands, kPeriodS, cruise, drawNoise(model.spread, random)));
    }
    average(patterns);
  }

  const PatternSet& set() const { return set_; }
  const std::vector<Pose2>& any(size_t pattern, std::mt19937_64& random) const {
    return executions_[pattern][random() % kExecutions];
  }
  const Pose2& averageEnd(size_t pattern) const { return set_.patterns()[pattern].end(); }

 private:
  void average(const std::vector<std::vector<TrackCommand>>& patterns) {
    PatternSetContent content = smallContent();
    content.patterns.clear();
    for (size_t p = 0; p < patterns.size(); ++p) {
      std::vector<Pose2> mean(patterns[p].size());
      for (const auto& execution : executions_[p])
        for (size_t t = 0; t < mean.size(); ++t)
          mean[t] = {mean[t].x + execution[t].x / kExecutions,
                     mean[t].y + execution[t].y / kExecutions,
                     mean[t].yaw + execution[t].yaw / kExecutions};
      content.patterns.push_back(
          pattern(static_cast<int>(p) + 1, "p" + std::to_string(p), {1.0, 1.0}, mean));
      content.patterns.back().commands = commandsOf(patterns[p]);
      content.patterns.back().end_covariance = spreadOf(executions_[p], mean.back());
    }
    set_ = checked(content);
  }
  static PoseCovariance spreadOf(const std::vector<std::vector<Pose2>>& executions,
                                 const Pose2& mean) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const auto& execution : executions) {
      const Pose2& end = execution.back();
      const Eigen::Vector3d apart(end.x - mean.x, end.y - mean.y, end.yaw - mean.yaw);
      sum += apart * apart.transpose() / (kExecutions - 1.0);
    }
    return {sum(0, 0), sum(0, 1), sum(0, 2), sum(1, 1), sum(1, 2), sum(2, 2)};
  }

  PatternSet set_;
  std::vector<std::vector<std::vector<Pose2>>> executions_;
};

/// Patterns of transitions: 0 left, 1 right.
std::vector<std::vector<TrackCommand>> sides() {
  return {turning(0.8, 1.0), turning(1.0, 0.8)};
}

/// Mean errors of the test sequences left-left-right and right-right-left after a transition.
struct Transition {
  double a = 0.0;  ///< without learning
  double d = 0.0;  ///< with the new surface's own set
  std::array<double, 3> each{};
  double mean() const { return (each[0] + each[1] + each[2]) / 3.0; }
};

Transition drive(Rule rule, const Recording& from, const Recording& to, int repetitions) {
  std::mt19937_64 random(11);
  const Pupil start(ruleConfig(rule, 0.3), from.set());
  Pupil pupil(start);
  Transition result;
  const double share = 1.0 / repetitions;
  for (int n = 0; n < repetitions; ++n) {
    pupil.rule().assign(Pupil(start).rule());
    const size_t first = random() % 2;
    for (size_t i = 0; i < 3; ++i) {
      const size_t executed = i < 2 ? first : 1 - first;
      const std::vector<Pose2>& measured = to.any(executed, random);
      result.each[i] += share * distance(pupil.end(executed), measured.back());
      result.a += share / 3.0 * distance(from.averageEnd(executed), measured.back());
      result.d += share / 3.0 * distance(to.averageEnd(executed), measured.back());
      pupil.learn(executed, measured);
    }
  }
  return result;
}

/// Growth of a hard left turn's width after many executions of a left one on the ground of both
/// recordings [1].
double widthAfter(Rule rule, uint64_t seed, int executions) {
  const Recording ground(cinder(), {turning(0.82, 1.0), turning(0.55, 1.0)}, seed);
  Pupil pupil(ruleConfig(rule), ground.set());
  std::mt19937_64 random(seed);
  for (int i = 0; i < executions; ++i) pupil.learn(0, ground.any(0, random));
  return boundingBox(pupil.prediction(1))[1] / boundingBox(pupil.shipped(1))[1];
}

/// Median, least and largest over recordings.
std::array<double, 3> widthsAfter300(Rule rule) {
  std::vector<double> widths;
  for (uint64_t seed = 1; seed <= 21; ++seed) widths.push_back(widthAfter(rule, seed, 300));
  std::sort(widths.begin(), widths.end());
  return {widths[widths.size() / 2], widths.front(), widths.back()};
}

/// Remaining error of a 90 degree turn after `executions` exact measurements of a gentle one, where
/// every yaw rate is 1.37 times the predicted one [m].
double quarterTurnError(Rule rule, int executions) {
  PatternSetContent content = smallContent();
  content.patterns = {pattern(1, "gentle", {0.9, 1.0}, arc({1.0, 0.0, 0.33})),
                      pattern(2, "quarter", {0.5, 1.0}, arc({1.0, 0.0, kPi / 2.0}))};
  Pupil pupil(ruleConfig(rule, 0.0), checked(content));
  for (int i = 0; i < executions; ++i) pupil.learn(0, arc({1.0, 0.0, 1.37 * 0.33}));
  return distance(pupil.end(1), arc({1.0, 0.0, 1.37 * kPi / 2.0}).back());
}

}  // namespace

TEST_CASE("single in the long run errs by sqrt(1 + (1 - w)/(1 + w)) of the omniscient error") {
  // 1.155 at w = 0.5, as in the paper's Figure 4 (.045 / .039); other memories have other plateaus.
  const Recording ground(grass(), sides(), 5);
  for (const double memory : {0.5, 0.3, 0.8}) {
    Pupil pupil(ruleConfig("single", memory), ground.set());
    std::mt19937_64 random(6);
    double learned = 0.0;
    double omniscient = 0.0;
    for (int i = 0; i < 40000; ++i) {
      const std::vector<Pose2>& measured = ground.any(0, random);
      learned += std::pow(distance(pupil.end(0), measured.back()), 2);
      omniscient += std::pow(distance(ground.averageEnd(0), measured.back()), 2);
      pupil.learn(0, measured);
    }
    const double plateau = std::sqrt(1.0 + (1.0 - memory) / (1.0 + memory));
    REQUIRE(std::sqrt(learned / omniscient) == Approx(plateau).epsilon(0.015));
    if (memory == 0.5) REQUIRE(plateau == Approx(1.155).margin(5e-4));
  }
}

TEST_CASE("collective drifts: a pattern that is never executed grows several times in width") {
  // Measured over 21 recordings: median 4.2, at most 54; 1 if the recorded spread marks the width
  // as noise for good.
  const auto [median, least, largest] = widthsAfter300("collective");
  REQUIRE(median > 3.0);
  REQUIRE(largest > 10.0);
  REQUIRE(least >= 1.0);
}

TEST_CASE("on unchanged ground no other rule drifts", "[statistics]") {
  // Measured over 21 recordings, median (range): telescoping 1.00 (.75 to 1.21; scatter of the
  // executed pattern's own box, which does not accumulate), multi_model 1.00 (.97 to 1.03).
  const auto stays = [](Rule rule, double median_within, double all_within) {
    INFO(rule);
    const auto [median, least, largest] = widthsAfter300(rule);
    REQUIRE(median == Approx(1.0).margin(median_within));
    REQUIRE(least > 1.0 - all_within);
    REQUIRE(largest < 1.0 + all_within);
  };
  stays("off", 0.0, 1e-12);
  stays("single", 0.0, 1e-12);
  stays("telescoping", 0.04, 0.35);
  stays("multi_model", 0.02, 0.05);
}

TEST_CASE("scaling rules freeze the ratios between patterns, however exactly all are measured") {
  // Ground that turns the gentle arc 1.3 times as predicted, the hard one as predicted. Each
  // execution of one spoils the prediction of the other; single and multi_model separate them.
  const auto truth = [](size_t p) {
    return p == kTurnLeft ? arc({0.9, 0.0, 1.3 * 0.5}) : arc({0.7, 0.0, 1.0});
  };
  const auto learned = [&](Rule rule) {
    Pupil pupil(ruleConfig(rule, 0.3), richSet());
    for (int round = 0; round < 60; ++round)
      for (const size_t p : {kTurnLeft, kHardLeft}) pupil.learn(p, truth(p));
    return std::pair(pupil.end(kTurnLeft).yaw, pupil.end(kHardLeft).yaw);
  };
  for (const Rule rule : {"collective", "telescoping"}) {
    const auto [gentle, hard] = learned(rule);
    REQUIRE(gentle / hard == Approx(0.5));
  }
  for (const Rule rule : {"single", "multi_model"}) {
    const auto [gentle, hard] = learned(rule);
    REQUIRE(gentle == Approx(0.65).margin(0.01));
    REQUIRE(hard == Approx(1.0).margin(0.01));
  }
}

TEST_CASE("a yaw gain from a gentle arc makes a 90 degree pattern worse when it is scaled") {
  const double unlearned = quarterTurnError("off", 1);
  REQUIRE(unlearned == Approx(0.262).margin(5e-4));
  REQUIRE(quarterTurnError("collective", 1) == Approx(0.279).margin(5e-4));
  REQUIRE(quarterTurnError("telescoping", 1) == Approx(0.279).margin(5e-4));
}

TEST_CASE("a yaw gain from a gentle arc makes a 90 degree pattern better in twist space") {
  // In body-twist space the exact gain would leave no error; multi_model attributes a part to the
  // gentle arc itself. Measured: .181 m after one execution, .099 after five.
  REQUIRE(quarterTurnError("multi_model", 1) < 0.19);
  REQUIRE(quarterTurnError("multi_model", 5) < 0.11);
}

TEST_CASE("a transition costs single (2 a + b2) / 3 in the mean, also with w = 0.3") {
  const Recording from(cinder(), sides(), 1);
  const Recording to(grass(), sides(), 2);
  const Transition single = drive("single", from, to, 10000);
  REQUIRE(single.mean() == Approx((2.0 * single.a + single.each[1]) / 3.0).epsilon(0.01));
}

TEST_CASE("no rule that must start on the other surface's set beats (a + 2 d) / 3") {
  const Recording from(cinder(), sides(), 1);
  const Recording to(grass(), sides(), 2);
  for (const Rule& rule : ruleNames()) {
    INFO(rule);
    const Transition driven = drive(rule, from, to, effort(3000));
    const double bound = (driven.a + 2.0 * driven.d) / 3.0;
    REQUIRE(driven.mean() > bound);
    REQUIRE(driven.mean() < 1.01 * driven.a);
    // The first execution is predicted from the other surface with every rule.
    REQUIRE(driven.each[0] == Approx(driven.a).epsilon(0.05));
    if (rule == "off") REQUIRE(driven.mean() == Approx(driven.a));
    if (rule != "off" && rule != "single") REQUIRE(driven.each[2] < 0.8 * driven.a);
  }
}

TEST_CASE("both scaling rules have the guards: one dimension, other direction, noise, limits") {
  PatternSetContent content = smallContent();
  content.patterns.push_back(pattern(6, "weak", {0.98, 1.0}, arc({0.9, 0.0, 0.06})));
  content.patterns.back().end_covariance = {1e-4, 0.0, 0.0, 1e-6, 0.0, 9e-4};
  content.patterns.push_back(pattern(7, "wait", {0.0, 0.0}, std::vector<Pose2>(20)));
  for (const Rule rule : {"collective", "telescoping"}) {
    INFO(rule);
    const Pupil fresh(ruleConfig(rule, 0.3), checked(content));
    const auto others_stay = [&](size_t executed, const std::vector<Pose2>& measured) {
      Pupil pupil(fresh);
      const RuleNote note = pupil.learn(executed, measured);
      for (size_t p = 0; p < pupil.patterns(); ++p)
        if (p != executed && pupil.end(p).x != fresh.end(p).x) return false;
      return std::isnan(note.scaling[0]);
    };
    REQUIRE(others_stay(0, arc({0.8, 0.05, 0.02})));  // straight
    REQUIRE(others_stay(3, arc({0.05, 0.0, 0.9})));   // in place
    REQUIRE(others_stay(6, arc({0.1, 0.0, 0.1})));    // at rest
    REQUIRE(others_stay(1, arc({0.9, 0.0, -0.4})));   // turned to the other side
    REQUIRE(others_stay(1, arc({-0.6, 0.0, 0.5})));   // went in the opposite direction
    REQUIRE_FALSE(others_stay(1, arc({0.8, 0.0, 0.6})));

    // 0.06 rad of yaw with a deviation of 0.03: its yaw is noise, and stays so under any scaling;
    // its width of 2.7 cm is known to 1 mm.
    Pupil pupil(fresh);
    pupil.learn(1, arc({0.9, 0.0, 0.8}));
    REQUIRE(pupil.end(5).yaw == fresh.end(5).yaw);
    REQUIRE(pupil.end(2).yaw != fresh.end(2).yaw);
    const RuleNote weak = pupil.learn(5, arc({0.8, 0.1, 0.3}));
    REQUIRE(weak.held == std::array<bool, 3>{false, false, true});
    REQUIRE(weak.scaling[1] != 1.0);
    REQUIRE(weak.scaling[2] == 1.0);

    // For any measurement one execution changes the others at most by a factor of two.
    Pupil wild(fresh);
    const RuleNote note = wild.learn(1, arc({1.5, 0.0, 1.4}));
    REQUIRE(note.scaling[0] <= 2.0);
    REQUIRE(note.scaling[2] == 2.0);
    REQUIRE(std::abs(wild.end(2).yaw) <= 2.0 * std::abs(fresh.end(2).yaw));
  }
}

TEST_CASE("a pattern whose prediction has shrunk to nothing is not divided by") {
  for (const Rule rule : {"collective", "telescoping"}) {
    Pupil pupil(ruleConfig(rule, 0.0), smallSet());
    const std::vector<Pose2> nothing(20);
    pupil.learn(1, nothing);
    pupil.learn(1, nothing);
    const double before = pupil.end(2).x;
    const RuleNote note = pupil.learn(1, arc({0.9, 0.0, 0.5}));
    REQUIRE(note.scaling.isFinite().all());
    REQUIRE(pupil.end(2).x == before);
    REQUIRE(pupil.end(1).yaw == Approx(0.5));
  }
}
