// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Properties of every rule for any measurements: finite, valid, symmetric, independent of order,
// repeatable.
#include <catch2/catch.hpp>

#include <algorithm>
#include <numeric>

#include "modules/learner/core/learner.hpp"
#include "tests/helpers.hpp"
#include "tests/learner/rule_bench.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;
using tread::testing::effort;

namespace {

using Random = std::mt19937_64;

double normal(Random& random) {
  return std::normal_distribution<double>(0.0, 1.0)(random);
}

/// A covariance of an end with these standard deviations and some correlation, or none.
PoseCovariance anyCovariance(Random& random) {
  if (random() % 2 == 0) return kUnknownCovariance;
  Eigen::Matrix3d root;
  for (int i = 0; i < 9; ++i) root(i / 3, i % 3) = 0.02 * normal(random);
  const Eigen::Matrix3d c = root * root.transpose();
  return {c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2)};
}

/// A set of random patterns: fast, slow, at rest, turning many times, of one sample.
PatternSet anySet(Random& random) {
  constexpr int64_t kPeriods[] = {5'000, 50'000, 200'000};
  PatternSetContent content;
  content.name = "any";
  content.period_us = kPeriods[random() % 3];
  content.classes = {{"cruise", {1.0, 0.0, 0.0}, {1.0, 1.0}}};
  const int patterns = 1 + static_cast<int>(random() % 8);
  for (int p = 1; p <= patterns; ++p) {
    const double speed = std::pow(10.0, -2.0 + 0.5 * static_cast<double>(random() % 6));
    const Twist2 twist{random() % 4 == 0 ? 0.0 : speed * normal(random),
                       random() % 2 == 0 ? 0.0 : 0.1 * speed * normal(random),
                       random() % 3 == 0 ? 0.0 : 2.0 * normal(random)};
    const double period = 1e-6 * static_cast<double>(content.period_us);
    auto trajectory = arc(twist, 1 + static_cast<int>(random() % 40), period);
    content.patterns.push_back(pattern(p, "p" + std::to_string(p), {1.0, 0.5}, trajectory));
    content.patterns.back().end_covariance = anyCovariance(random);
  }
  return checked(content);
}

/// Finite, but not drivable by a vehicle; or drivable.
std::vector<Pose2> anyMeasurement(const std::vector<Pose2>& shipped, double period,
                                  Random& random) {
  constexpr double kScales[] = {0.0, 1e-300, 1.0, 1e6, 1e150, 1e300, 1.7e308};
  const double scale = kScales[random() % 7];
  const Pose2 one{scale * std::tanh(normal(random)), scale * std::tanh(normal(random)),
                  scale * std::tanh(normal(random))};
  std::vector<Pose2> measured = shipped;
  switch (random() % 6) {
    case 0:  // all equal
      std::fill(measured.begin(), measured.end(), one);
      return measured;
    case 1:  // alternating signs
      for (size_t t = 0; t < measured.size(); ++t)
        measured[t] = t % 2 == 0 ? one : Pose2{-one.x, -one.y, -one.yaw};
      return measured;
    case 2:  // independent
      for (Pose2& pose : measured)
        pose = {scale * std::tanh(normal(random)), scale * std::tanh(normal(random)),
                scale * std::tanh(normal(random))};
      return measured;
    case 3:  // backwards
      for (Pose2& pose : measured) pose = {-pose.x, -pose.y, -pose.yaw};
      return measured;
    default:
      return under({1.0 + 0.3 * normal(random), 1.0 + 0.3 * normal(random), 0.1 * normal(random),
                    0.05 * normal(random)},
                   shipped, period);
  }
}

bool allFinite(const std::vector<double>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double n) { return std::isfinite(n); });
}

Pose2 mirrored(const Pose2& pose) {
  return {pose.x, -pose.y, -pose.yaw};
}

std::vector<Pose2> mirrored(std::vector<Pose2> poses) {
  for (Pose2& pose : poses) pose = mirrored(pose);
  return poses;
}

PatternSet mirrored(const PatternSet& set) {
  PatternSetContent content = set.content();
  for (MotionClass& entry : content.classes) {
    entry.twist = {entry.twist.v_x, -entry.twist.v_y, -entry.twist.omega};
    std::swap(entry.steady[0], entry.steady[1]);
  }
  for (MotionPattern& pattern : content.patterns) {
    pattern.trajectory = mirrored(pattern.trajectory);
    for (Command& command : pattern.commands) std::swap(command[0], command[1]);
    for (const size_t mixed : {1, 2}) pattern.end_covariance[mixed] *= -1.0;
  }
  return checked(content);
}

bool near(const Pose2& a, const Pose2& b) {
  return distance(a, b) < 1e-9 && std::abs(a.yaw - b.yaw) < 1e-9;
}

/// Changes of ground, and executions with scatter.
std::vector<Pose2> nextExecution(const std::vector<Pose2>& shipped, int i, double period,
                                 Random& random) {
  const GroundEffect grounds[] = {
      {1.0, 1.0, 0.0, 0.0}, {0.85, 1.5, 0.0, 0.02}, {1.15, 0.6, 0.1, -0.01}};
  return under(drawn(grounds[i / 25 % 3], {0.02, 0.05, 0.02}, random), shipped, period);
}

}  // namespace

TEST_CASE("no rule ever predicts what is not a number, whatever finite thing was measured") {
  for (const Rule& rule : ruleNames()) {
    for (uint64_t seed = 1; seed <= static_cast<uint64_t>(effort(60)); ++seed) {
      INFO(rule << ", seed " << seed);
      Random random(seed);
      const PatternSet set = anySet(random);
      Pupil pupil(ruleConfig(rule, 0.3), set);
      for (int i = 0; i < 100; ++i) {
        const size_t executed = random() % pupil.patterns();
        const RuleNote note = pupil.learn(
            executed, anyMeasurement(pupil.shipped(executed), set.periodSeconds(), random));
        REQUIRE_FALSE(note.change_probability < 0.0);
        REQUIRE_FALSE(note.surface_probability > 1.0 + 1e-9);
        if (i % 10 != 9) continue;
        REQUIRE(allFinite(pupil.everything()));
        REQUIRE(allFinite(pupil.rule().memory()));
        for (size_t p = 0; p < pupil.patterns(); ++p)
          if (const auto covariance = pupil.rule().endCovariance(p))
            REQUIRE(allFinite({covariance->begin(), covariance->end()}));
      }
    }
  }
}

TEST_CASE(
    "what a learner publishes is always a valid set with continuous yaw, and the rule's own") {
  for (const Rule& rule : ruleNames()) {
    for (uint64_t seed = 1; seed <= static_cast<uint64_t>(effort(20)); ++seed) {
      INFO(rule << ", seed " << seed);
      Random random(seed);
      Learner learner(ruleConfig(rule, 0.3), anySet(random));
      const double period = learner.set().periodSeconds();
      for (int i = 0; i < 60; ++i) {
        const auto& patterns = learner.shipped().patterns();
        const MotionPattern& executed = patterns[random() % patterns.size()];
        const Measurement measured = fair(anyMeasurement(executed.trajectory, period, random));
        const int64_t version = learner.set().version();
        const bool changed = learner.learn(executed.id, measured, std::nullopt, i).changed;
        const int64_t step = learner.learnsParts() ? Learner::kVersions : 1;
        REQUIRE(learner.set().version() == version + (changed ? step : 0));
        std::string why;
        REQUIRE(PatternSet::make(learner.set().content(), why));
        for (size_t p = 0; p < patterns.size(); ++p) {
          const MotionPattern& published = learner.set().patterns()[p];
          Pose2 last;
          for (const Pose2& pose : published.trajectory) {
            REQUIRE(distance(pose, last) <= 20.0 * period * (1.0 + 1e-9));
            REQUIRE(std::abs(pose.yaw - last.yaw) <= 20.0 * period * (1.0 + 1e-9));
            last = pose;
          }
          // A withdrawn correction is also withdrawn in the rule.
          if (i > 0) REQUIRE(near(learner.rule().predictEnd(p), published.end()));
        }
      }
    }
  }
}

TEST_CASE("after absurd measurements a rule comes back to the truth") {
  // Unlike the scaling rules, which keep the effect of absurd measurements on the patterns' ratios
  // (test_rules_paper.cpp); the learner's gates exclude such measurements.
  const GroundEffect ground{1.05, 1.2, 0.0, 0.0};
  for (const Rule rule : {"single", "multi_model"}) {
    INFO(rule);
    Random random(3);
    Learner learner(ruleConfig(rule, 0.3), richSet());
    for (int i = 0; i < 300; ++i) {
      const MotionPattern& executed = learner.shipped().patterns()[random() % 7];
      learner.learn(executed.id, fair(anyMeasurement(executed.trajectory, 0.05, random)), {}, i);
    }
    for (int i = 0; i < 40; ++i)
      for (const MotionPattern& shipped : learner.shipped().patterns())
        learner.learn(shipped.id, fair(under(ground, shipped.trajectory)), {}, i);
    double sum = 0.0;
    for (const MotionPattern& shipped : learner.shipped().patterns())
      sum += distance(learner.set().find(shipped.id)->end(),
                      under(ground, shipped.trajectory).back()) /
             7.0;
    REQUIRE(sum < 0.05);
  }
}

TEST_CASE("mirrored input gives mirrored output") {
  for (const Rule& rule : ruleNames()) {
    for (uint64_t seed = 1; seed <= static_cast<uint64_t>(effort(20)); ++seed) {
      INFO(rule << ", seed " << seed);
      Random random(seed);
      const PatternSet set = seed % 2 == 0 ? anySet(random) : richSet();
      Pupil pupil(ruleConfig(rule, 0.3), set);
      Pupil mirror(ruleConfig(rule, 0.3), mirrored(set));
      for (int i = 0; i < 100; ++i) {
        const size_t executed = random() % pupil.patterns();
        const auto measured =
            nextExecution(pupil.shipped(executed), i, set.periodSeconds(), random);
        const RuleNote note = pupil.learn(executed, measured);
        REQUIRE(mirror.learn(executed, mirrored(measured)).surface == note.surface);
        for (size_t p = 0; p < pupil.patterns(); ++p)
          REQUIRE(near(mirror.end(p), mirrored(pupil.end(p))));
      }
      for (size_t p = 0; p < pupil.patterns(); ++p) {
        const auto ours = mirrored(pupil.prediction(p));
        const auto theirs = mirror.prediction(p);
        REQUIRE(std::equal(ours.begin(), ours.end(), theirs.begin(), near));
        const auto c = pupil.rule().endCovariance(p);
        const auto m = mirror.rule().endCovariance(p);
        constexpr double kSigns[] = {1.0, -1.0, -1.0, 1.0, 1.0, 1.0};
        for (size_t k = 0; c && k < 6; ++k)
          REQUIRE((*m)[k] == Approx(kSigns[k] * (*c)[k]).margin(1e-9));
      }
    }
  }
}

TEST_CASE("in a symmetric set right learns from left what left learns from right") {
  constexpr size_t kOther[] = {kAhead, kTurnRight, kTurnLeft, kHardRight, kHardLeft};
  for (const Rule& rule : ruleNames()) {
    INFO(rule);
    // Without the turn in place, which has no mirror image here.
    PatternSetContent content = richContent();
    content.patterns.resize(5);
    Pupil pupil(ruleConfig(rule, 0.3), checked(content));
    Pupil mirror(pupil);
    Random random(4);
    for (int i = 0; i < 100; ++i) {
      const size_t executed = random() % 5;
      const auto measured = nextExecution(pupil.shipped(executed), i, 0.05, random);
      pupil.learn(executed, measured);
      mirror.learn(kOther[executed], mirrored(measured));
      for (size_t p = 0; p < 5; ++p) REQUIRE(near(mirror.end(kOther[p]), mirrored(pupil.end(p))));
    }
  }
}

TEST_CASE("the order of the patterns in the set does not matter") {
  for (const Rule& rule : ruleNames()) {
    for (uint64_t seed = 1; seed <= static_cast<uint64_t>(effort(20)); ++seed) {
      INFO(rule << ", seed " << seed);
      Random random(seed);
      const PatternSet set = seed % 2 == 0 ? anySet(random) : richSet();
      std::vector<size_t> from(set.patterns().size());  // index in the other set -> index here
      std::iota(from.begin(), from.end(), size_t{0});
      std::shuffle(from.begin(), from.end(), random);
      PatternSetContent content = set.content();
      for (size_t p = 0; p < from.size(); ++p) content.patterns[p] = set.patterns()[from[p]];
      Pupil pupil(ruleConfig(rule, 0.3), set);
      Pupil other(ruleConfig(rule, 0.3), checked(content));
      for (int i = 0; i < 100; ++i) {
        const size_t place = random() % from.size();
        const auto measured = nextExecution(other.shipped(place), i, set.periodSeconds(), random);
        const RuleNote note = other.learn(place, measured);
        REQUIRE(pupil.learn(from[place], measured).surface == note.surface);
        for (size_t p = 0; p < from.size(); ++p) REQUIRE(near(other.end(p), pupil.end(from[p])));
      }
    }
  }
}

TEST_CASE("same input, same bytes: also from a clone, and after assigning") {
  for (const Rule& rule : ruleNames()) {
    for (uint64_t seed = 1; seed <= static_cast<uint64_t>(effort(10)); ++seed) {
      INFO(rule << ", seed " << seed);
      Random random(seed);
      const PatternSet set = seed % 2 == 0 ? anySet(random) : richSet();
      Pupil first(ruleConfig(rule), set);
      Pupil second(ruleConfig(rule), set);
      Pupil other(ruleConfig(rule), set);  // has learned something else before
      for (int i = 0; i < 45; ++i) {
        const size_t executed = random() % other.patterns();
        other.learn(executed,
                    nextExecution(other.shipped(executed), i + 40, set.periodSeconds(), random));
      }
      const auto both = [&](Pupil& a, Pupil& b, int from, int to) {
        for (int i = from; i < to; ++i) {
          const size_t executed = random() % a.patterns();
          const auto measured =
              random() % 10 == 0
                  ? anyMeasurement(a.shipped(executed), set.periodSeconds(), random)
                  : nextExecution(a.shipped(executed), i, set.periodSeconds(), random);
          a.learn(executed, measured);
          b.learn(executed, measured);
        }
        REQUIRE(a.everything() == b.everything());
        REQUIRE(a.rule().memory() == b.rule().memory());
      };
      both(first, second, 0, 57);
      Pupil clone(first);
      both(second, clone, 57, 80);
      other.rule().assign(second.rule());
      REQUIRE(other.everything() == second.everything());
      both(second, other, 80, 130);
      // The source of the copy is unchanged.
      const bool apart = first.everything() != second.everything();
      REQUIRE(apart == (rule != "off"));
    }
  }
}
