// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Properties of Table I that follow from the paper's definitions on any surfaces.
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/tools/lab/experiment/small_world.hpp"

namespace tread::experiment {
namespace {

using namespace testing;

constexpr size_t kOff = 0, kSingle = 1, kCollective = 2, kBest = 4;

ExperimentErrors smallExperiment() {
  const std::vector<TrialGround> grounds = groundsOfText(kSmallWorld);
  return runExperiment(grounds, smallSettings(), {});
}

}  // namespace

TEST_CASE("simple learning errs as none at first and at the pattern that it did not execute yet") {
  for (const TransitionErrors& transition : smallExperiment().transitions)
    for (const size_t execution : {0U, 2U}) {
      const MethodErrors& errors = transition.development[execution];
      CHECK(errors.position.error(kSingle).value == errors.position.error(kOff).value);
      CHECK(errors.orientation.error(kSingle).value == errors.orientation.error(kOff).value);
    }
}

TEST_CASE("b = (2 a + b2) / 3, b2 the error after one update of its own") {
  for (const TransitionErrors& transition : smallExperiment().transitions) {
    const MethodErrors& all = transition.sequences.errors;
    const double a = all.orientation.error(kOff).value;
    const double b2 = transition.development[1].orientation.error(kSingle).value;
    CHECK(all.orientation.error(kSingle).value == Approx((2.0 * a + b2) / 3.0).epsilon(0.03));
  }
}

TEST_CASE("who must begin with the old set cannot beat (a + 2 d) / 3, and the right set is best") {
  for (const TransitionErrors& transition : smallExperiment().transitions) {
    const RatioMoments& yaw = transition.sequences.errors.orientation;
    const double a = yaw.error(kOff).value, d = yaw.error(kBest).value;
    for (const size_t rule : {kSingle, kCollective}) {
      CHECK(yaw.error(rule).value > (a + 2.0 * d) / 3.0);
      CHECK(yaw.error(rule).value < a);
    }
    CHECK(d < a);
  }
}

TEST_CASE("in the long run smoothing with w = 0.5 costs sqrt(1 + w / (2 - w)) = 1.155") {
  // Errors are absolute values: without bias the factor is that of their standard deviation.
  for (const MethodErrors& errors : smallExperiment().unchanged) {
    CHECK(errors.orientation.ratio(kSingle, kBest).value ==
          Approx(std::sqrt(1.0 + 0.5 / 1.5)).epsilon(0.02));
    CHECK(errors.position.ratio(kOff, kBest).value == 1.0);
  }
}

TEST_CASE("a change of ground inside a pattern slows learning down, but does not break it") {
  const std::vector<TrialGround> grounds = groundsOfText(kSmallWorld);
  ExperimentSettings settings = smallSettings();
  const ExperimentErrors between = runExperiment(grounds, settings, {});
  settings.change_inside = true;
  const ExperimentErrors inside = runExperiment(grounds, settings, {});
  for (size_t t = 0; t < between.transitions.size(); ++t) {
    const RatioMoments& at_once = between.transitions[t].development[1].orientation;
    const RatioMoments& slowed = inside.transitions[t].development[1].orientation;
    CHECK(slowed.error(kCollective).value > at_once.error(kCollective).value);
    CHECK(slowed.error(kCollective).value < slowed.error(kOff).value);
    const RatioMoments& later = inside.transitions[t].development[8].orientation;
    CHECK(later.error(kCollective).value < 1.4 * later.error(kBest).value);
  }
}

}  // namespace tread::experiment
