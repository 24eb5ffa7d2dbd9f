// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Effects of slope and battery are separated from those of the ground, and used if they improve
// predictions.
#include <catch2/catch.hpp>

#include <functional>

#include "modules/learner/core/rules/context_effects.hpp"
#include "tests/learner/rule_bench.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;

namespace {

Pupil pupilOf(double evidence) {
  RuleConfig config = ruleConfig("multi_model");
  config.ground.context_evidence = evidence;
  return {config, richSet()};
}
constexpr double kNever = 1000.0;

const ContextEffects& effectsOf(Pupil& pupil) {
  return dynamic_cast<const MultiModel&>(pupil.rule()).effects();
}

/// Mean error of the ends of all patterns on a ground [m].
double errorOn(const Pupil& pupil, const GroundEffect& ground) {
  double sum = 0.0;
  for (size_t p = 0; p < pupil.patterns(); ++p)
    sum += distance(pupil.end(p), under(ground, pupil.shipped(p)).back());
  return sum / static_cast<double>(pupil.patterns());
}

/// Drives on; the context of each execution affects its motion.
void drive(Pupil& pupil, int executions, std::mt19937_64& random,
           const std::function<std::pair<Context, GroundEffect>(int)>& world) {
  for (int i = 0; i < executions; ++i) {
    const auto [context, ground] = world(i);
    const size_t p = random() % pupil.patterns();
    pupil.learn(p, under(drawn(ground, kCalm, random), pupil.shipped(p)), context);
  }
}

Context at(double voltage) {
  Context context;
  context.voltage = voltage;
  return context;
}

Context on(double ahead) {
  Context context;
  context.tilt = {std::abs(ahead), ahead, 0.0};
  return context;
}

/// A pupil after 60 executions under a sagging voltage that reduces speed, and one at a low
/// voltage.
Pupil afterSag(int seed, double evidence) {
  std::mt19937_64 random(static_cast<uint64_t>(seed));
  std::uniform_real_distribution<double> sag(-0.15, 0.0);
  Pupil pupil = pupilOf(evidence);
  drive(pupil, 60, random, [&](int i) {
    const double s = i == 0 ? 0.0 : sag(random);
    return std::make_pair(at(25.0 * (1.0 + s)), GroundEffect{1.0 + s, 1.0 + s, 0.0, 0.0});
  });
  // The voltage of the last execution is used for the next one.
  pupil.learn(kAhead, under({0.87, 0.87, 0.0, 0.0}, pupil.shipped(kAhead)), at(25.0 * 0.87));
  return pupil;
}

}  // namespace

TEST_CASE("the effect of a sagging voltage is separated from the ground, and predicted",
          "[statistics]") {
  double with = 0.0;
  double without = 0.0;
  int found = 0;  // the forward effect was found; measured: in 11 of 20
  const int seeds = 20;
  for (int seed = 1; seed <= seeds; ++seed) {
    for (const double evidence : {5.0, kNever}) {
      Pupil pupil = afterSag(seed, evidence);
      const double error = errorOn(pupil, {0.87, 0.87, 0.0, 0.0});
      (evidence < kNever ? with : without) += error / seeds;
      if (evidence < kNever && effectsOf(pupil).counts(0, ContextEffects::kVoltage)) ++found;
    }
  }
  CAPTURE(with, without, found);
  // Measured .66.
  REQUIRE(found >= 0.45 * seeds);
  REQUIRE(with < 0.75 * without);
}

TEST_CASE("a voltage that takes speed along comes to count") {
  int found = 0;
  for (int seed = 1; seed <= 4; ++seed) {
    Pupil pupil = afterSag(seed, 5.0);
    found += effectsOf(pupil).counts(0, ContextEffects::kVoltage) ? 1 : 0;
  }
  REQUIRE(found > 0);
}

TEST_CASE("the effect of a slope is subtracted, so that level ground is known better",
          "[statistics]") {
  double with = 0.0;
  double without = 0.0;
  const int seeds = 20;
  for (int seed = 1; seed <= seeds; ++seed) {
    for (const double evidence : {5.0, kNever}) {
      std::mt19937_64 random(static_cast<uint64_t>(seed));
      std::uniform_real_distribution<double> rise(-0.15, 0.15);
      Pupil pupil = pupilOf(evidence);
      // A forward pattern loses uphill what it gains downhill; a hill of 20 executions.
      drive(pupil, 80, random, [&](int i) {
        const double ahead = i % 40 < 20 ? 0.12 : rise(random);
        return std::make_pair(on(ahead), GroundEffect{1.0 - 1.5 * ahead, 1.0, 0.0, 0.0});
      });
      double error = 0.0;
      for (const size_t p : {kAhead, kTurnLeft, kTurnRight, kHardLeft, kHardRight})
        error += distance(pupil.end(p), pupil.shipped(p).back()) / 5.0;
      (evidence < kNever ? with : without) += error / seeds;
    }
  }
  CAPTURE(with, without);
  // Measured .88: a hill of twenty executions looks like another ground.
  REQUIRE(with < 0.95 * without);
}

TEST_CASE("a context without effect counts in at most 5 % of cases and costs less than 1 %",
          "[statistics]") {
  double with = 0.0;
  double without = 0.0;
  int counted = 0;
  const int seeds = 40;
  for (int seed = 1; seed <= seeds; ++seed) {
    for (const double evidence : {5.0, kNever}) {
      std::mt19937_64 random(static_cast<uint64_t>(seed));
      std::uniform_real_distribution<double> drawn_rise(-0.15, 0.15);
      std::uniform_real_distribution<double> sag(-0.15, 0.0);
      Pupil pupil = pupilOf(evidence);
      for (int i = 0; i < 60; ++i) {
        drive(pupil, 1, random, [&](int) {
          Context context = on(drawn_rise(random));
          context.voltage = 25.0 * (1.0 + sag(random));
          return std::make_pair(context, i < 30 ? kMeadow : kMud);
        });
        (evidence < kNever ? with : without) += errorOn(pupil, i < 30 ? kMeadow : kMud);
      }
      if (evidence == kNever) continue;
      for (size_t velocity = 0; velocity < kVelocities; ++velocity)
        for (const auto input : {ContextEffects::kSlope, ContextEffects::kVoltage})
          counted += effectsOf(pupil).counts(velocity, input) ? 1 : 0;
    }
  }
  CAPTURE(with, without, counted);
  REQUIRE(counted <= 0.05 * 5 * seeds);
  REQUIRE(with < 1.01 * without);
}

TEST_CASE("an unknown context changes nothing") {
  Pupil told = pupilOf(5.0);
  Pupil untold = pupilOf(5.0);
  std::mt19937_64 random(3);
  for (int i = 0; i < 40; ++i) {
    const size_t p = random() % told.patterns();
    const auto measured = under(drawn(kMud, kCalm, random), told.shipped(p));
    Context nothing;
    nothing.voltage = i % 2 == 0 ? Context{}.voltage : 0.0;
    told.learn(p, measured, nothing);
    untold.learn(p, measured);
    REQUIRE(told.everything() == untold.everything());
  }
}
