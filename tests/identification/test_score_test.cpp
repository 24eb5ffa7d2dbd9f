// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "core_rig.hpp"
#include "modules/identification/core/score_test.hpp"

using namespace tread;
using namespace tread::gap;
using samples::blockNoise;
using samples::Rig;
using samples::waves;

namespace {

constexpr int kDraws = 399;
constexpr int kCandidates = 24;
constexpr int kSeeds = 200;
constexpr double kAlpha = 0.05;

double largestScore(const ScoreTest& test) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < test.candidates(); ++i)
    largest = std::max(largest, std::abs(test.score(i)));
  return largest;
}

/// A direction that acts in five blocks of twenty.
Eigen::VectorXd rareDirection(const Observations& data) {
  Eigen::VectorXd direction = waves(data, 1).col(0);
  for (Eigen::Index i = 0; i < direction.size(); ++i)
    if (data.all()[static_cast<size_t>(i)].block % 4 != 1) direction[i] = 0.0;
  return direction;
}

/// The rare direction's evidence among the waves, when it is there with a size.
double rareEvidence(const Rig& rig, double size, uint64_t seed, bool first = false) {
  Eigen::MatrixXd directions(rig.size(), kCandidates + 1);
  directions << waves(rig.data, kCandidates), rareDirection(rig.data);
  const Eigen::VectorXd residuals =
      blockNoise(rig.data, seed, 0.1) + size * directions.col(kCandidates);
  const ScoreTest test(rig.data, rig.stateOf(residuals, 1.0), directions, rig.all);
  CHECK(test.activeBlocks(kCandidates) < 6.0);
  const Needed needed{criticalScore(test.largestByChance(kDraws, seed), kAlpha),
                      test.usualOverdispersion(), first};
  return evidence(test, kCandidates, needed);
}

}  // namespace

TEST_CASE(
    "correlated noise is called an effect about as often as alpha says, over all candidates") {
  const Rig rig({}, 400.0, 1);
  const Eigen::MatrixXd directions = waves(rig.data, kCandidates);
  int false_alarms = 0;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const ScoreTest test(rig.data, rig.stateOf(blockNoise(rig.data, seed), 1.0), directions,
                         rig.all);
    if (familyWise(test.largestByChance(kDraws, seed), largestScore(test)) <= kAlpha)
      ++false_alarms;
  }
  // 10 are expected; a thousandth of all honest tests lies outside of these.
  CHECK(false_alarms >= 2);
  CHECK(false_alarms <= 21);
}

TEST_CASE("a direction that is in the residuals is found among the others, with its size") {
  const Rig rig({}, 400.0, 1);
  const Eigen::MatrixXd directions = waves(rig.data, kCandidates);
  constexpr Eigen::Index kHidden = 1;
  constexpr double kSize = 1.0;
  int found = 0;
  double mean = 0.0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const Eigen::VectorXd residuals = blockNoise(rig.data, seed) + kSize * directions.col(kHidden);
    const ScoreTest test(rig.data, rig.stateOf(residuals, 1.0), directions, rig.all);
    if (familyWise(test.largestByChance(kDraws, seed), test.score(kHidden)) <= kAlpha) ++found;
    mean += test.size(kHidden) / 20.0;
    CHECK(test.promise(kHidden) > 0.0);
  }
  CHECK(found >= 18);
  CHECK(mean == Approx(kSize).epsilon(0.25));  // first order, and heavy tails are assumed
}

TEST_CASE("what the free parameters explain is no candidate's merit") {
  const Rig rig({}, 300.0, 1);
  const Eigen::MatrixXd directions = waves(rig.data, 2);
  FitState state = rig.stateOf(blockNoise(rig.data, 1) + 2.0 * directions.col(0), 1.0);
  const ScoreTest before(rig.data, state, directions, rig.all);
  CHECK(before.uniqueness(0) == Approx(1.0));
  CHECK(std::abs(before.score(0)) > 3.0);
  state.free.push_back(freeParameter(state.model, "yaw_pull.pull"));
  state.jacobian = directions.col(0);
  const ScoreTest after(rig.data, state, directions, rig.all);
  CHECK(after.score(0) == 0.0);
  CHECK(after.uniqueness(0) == 0.0);
  CHECK(after.uniqueness(1) == Approx(1.0));  // of another channel
}

TEST_CASE("an effect that few blocks excite counts by a clear size") {
  const Rig rig({}, 400.0, 1);
  int found = 0;
  int found_first = 0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    found += rareEvidence(rig, 2.0, seed) >= 1.0;
    found_first += rareEvidence(rig, 2.0, seed, true) >= 1.0;
  }
  CHECK(found >= 18);
  CHECK(found_first >= 16);  // when nothing else is known it takes more
}

TEST_CASE("chance in few blocks is no evidence") {
  const Rig rig({}, 400.0, 1);
  int found = 0;
  int found_first = 0;
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    found += rareEvidence(rig, 0.0, seed) >= 1.0;
    found_first += rareEvidence(rig, 0.0, seed, true) >= 1.0;
  }
  CHECK(found <= 2);
  CHECK(found_first <= 2);
}

TEST_CASE("p values count the observed drive in, and the critical score is its quantile") {
  const std::vector<double> chance{1.0, 2.0, 3.0, 4.0};
  CHECK(familyWise(chance, 5.0) == Approx(0.2));
  CHECK(familyWise(chance, -5.0) == Approx(0.2));
  CHECK(familyWise(chance, 2.5) == Approx(0.6));
  CHECK(criticalScore(chance, 0.25) == 4.0);
  CHECK(std::isinf(criticalScore({}, 0.05)));
  CHECK(chanceOfSize(2.0, 1) < 1e-10);
  CHECK(chanceOfSize(0.1, 1000) == 1.0);
}
