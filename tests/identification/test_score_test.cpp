// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <random>

#include "core_rig.hpp"
#include "modules/identification/core/observations.hpp"
#include "modules/identification/core/screening.hpp"

using namespace tread;
using namespace tread::gap;
using samples::blockNoise;
using samples::Rig;
using samples::waves;

namespace {

constexpr int kDraws = 399;
constexpr int kCandidates = 24;
constexpr int kSeeds = 200;
constexpr double kLevel = 0.05;

double largestScore(const ScoreTest& test) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < test.candidates(); ++i)
    largest = std::max(largest, std::abs(test.score(i)));
  return largest;
}

/// A direction that acts in five of twenty blocks.
Eigen::VectorXd rareDirection(const Observations& data) {
  Eigen::VectorXd direction = waves(data, 1).col(0);
  for (Eigen::Index i = 0; i < direction.size(); ++i)
    if (data.all()[static_cast<size_t>(i)].block % 4 != 1) direction[i] = 0.0;
  return direction;
}

/// The rare direction's evidence among the waves, for a given size.
double rareEvidence(const Rig& rig, double size, uint64_t seed, bool first = false) {
  Eigen::MatrixXd directions(rig.size(), kCandidates + 1);
  directions << waves(rig.data, kCandidates), rareDirection(rig.data);
  const Eigen::VectorXd residuals =
      blockNoise(rig.data, seed, 0.1) + size * directions.col(kCandidates);
  const ScoreTest test(rig.fitter, rig.stateOf(residuals, 1.0), directions);
  CHECK(test.activeBlocks(kCandidates) < 6.0);
  const Needed needed{criticalScore(test.largestByChance(kDraws, seed), kLevel),
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
    const ScoreTest test(rig.fitter, rig.stateOf(blockNoise(rig.data, seed), 1.0), directions);
    if (familyWise(test.largestByChance(kDraws, seed), largestScore(test)) <= kLevel)
      ++false_alarms;
  }
  // 10 are expected; .1 % of all correct tests are outside of these limits.
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
    const ScoreTest test(rig.fitter, rig.stateOf(residuals, 1.0), directions);
    if (familyWise(test.largestByChance(kDraws, seed), test.score(kHidden)) <= kLevel) ++found;
    mean += test.size(kHidden) / 20.0;
    CHECK(test.promise(kHidden) > 0.0);
  }
  CHECK(found >= 18);
  CHECK(mean == Approx(kSize).epsilon(0.25));  // first order, assuming heavy tails
}

TEST_CASE("what the free parameters explain is no candidate's merit") {
  const Rig rig({}, 300.0, 1);
  const Eigen::MatrixXd directions = waves(rig.data, 2);
  FitState state = rig.stateOf(blockNoise(rig.data, 1) + 2.0 * directions.col(0), 1.0);
  const ScoreTest before(rig.fitter, state, directions);
  CHECK(before.uniqueness(0) == Approx(1.0));
  CHECK(std::abs(before.score(0)) > 3.0);
  state.free.push_back(freeParameter(state.model, "yaw_pull.pull"));
  state.jacobian = directions.col(0);
  const ScoreTest after(rig.fitter, state, directions);
  CHECK(after.score(0) == 0.0);
  CHECK(after.uniqueness(0) == 0.0);
  CHECK(after.uniqueness(1) == Approx(1.0));  // a different channel
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
  CHECK(found_first >= 16);  // as the only knowledge it has more effect
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

TEST_CASE("a score is the sum of the blocks' pulls over the root of their squares") {
  const Rig rig({}, 200.0, 1);
  const Eigen::MatrixXd directions = waves(rig.data, 3);
  const Eigen::VectorXd residuals = blockNoise(rig.data, 7);
  constexpr double kScale = 0.8;
  const ScoreTest test(rig.fitter, rig.stateOf(residuals, kScale), directions);
  REQUIRE(test.candidates() == 3);
  for (Eigen::Index c = 0; c < 3; ++c) {
    std::vector<double> pulls(static_cast<size_t>(rig.data.blocks()), 0.0);
    double information = 0.0;
    for (Eigen::Index i = 0; i < residuals.size(); ++i) {
      pulls[static_cast<size_t>(rig.data.all()[static_cast<size_t>(i)].block)] +=
          pullOf(residuals[i], kScale) * directions(i, c);
      information += 5.0 / 7.0 * std::pow(directions(i, c) / kScale, 2);
    }
    double sum = 0.0;
    double squares = 0.0;
    for (const double pull : pulls) {
      sum += pull;
      squares += pull * pull;
    }
    CHECK(test.score(c) == Approx(sum / std::sqrt(squares)));
    CHECK(test.size(c) == Approx(sum / information));
    CHECK(test.sizeError(c) == Approx(std::sqrt(squares) / information));
    CHECK(test.promise(c) == Approx(0.5 * sum * sum / information));
    CHECK(test.uniqueness(c) == Approx(1.0));
  }
}

TEST_CASE("the unit of a candidate changes its size and nothing else") {
  const Rig rig({}, 200.0, 1);
  Eigen::MatrixXd directions(rig.size(), 2);
  directions << waves(rig.data, 1).col(0), -40.0 * waves(rig.data, 1).col(0);
  const ScoreTest test(rig.fitter, rig.stateOf(blockNoise(rig.data, 3), 1.0), directions);
  CHECK(test.score(1) == Approx(-test.score(0)));
  CHECK(test.size(1) == Approx(-test.size(0) / 40.0));
  CHECK(test.sizeError(1) == Approx(test.sizeError(0) / 40.0));
  CHECK(test.promise(1) == Approx(test.promise(0)));
  CHECK(test.activeBlocks(1) == Approx(test.activeBlocks(0)));
  CHECK(test.overdispersion(1) == Approx(test.overdispersion(0)));
}

TEST_CASE("no score exceeds the root of the number of blocks in which its direction acts") {
  const Rig rig({}, 200.0, 1);
  Eigen::MatrixXd directions = waves(rig.data, 1);
  for (Eigen::Index i = 0; i < directions.rows(); ++i)
    if (rig.data.all()[static_cast<size_t>(i)].block >= 3) directions(i, 0) = 0.0;
  for (const double size : {0.0, 1.0, 1e3}) {
    const ScoreTest test(rig.fitter,
                         rig.stateOf(blockNoise(rig.data, 4) + size * directions.col(0), 1.0),
                         directions);
    CHECK(std::abs(test.score(0)) <= std::sqrt(3.0) + 1e-12);
    CHECK(test.activeBlocks(0) <= 3.0 + 1e-12);
    CHECK(test.activeBlocks(0) > 2.5);
  }
}

TEST_CASE("rows that do not count change no bit of a score test") {
  const Rig rig({}, 200.0, 1);
  const Eigen::MatrixXd directions = waves(rig.data, 4);
  std::vector<char> mask = rig.fitter.mask();
  Eigen::VectorXd residuals = blockNoise(rig.data, 5);
  Eigen::VectorXd spoilt = residuals;
  for (size_t i = 0; i < mask.size(); i += 3) {
    mask[i] = 0;
    spoilt[static_cast<Eigen::Index>(i)] = 1e6;
  }
  const Fitter part = rig.fitter.onRows(mask);
  const ScoreTest test(part, rig.stateOf(residuals, 1.0), directions);
  const ScoreTest same(part, rig.stateOf(spoilt, 1.0), directions);
  for (Eigen::Index c = 0; c < 4; ++c) {
    CHECK(same.score(c) == test.score(c));
    CHECK(same.size(c) == test.size(c));
  }
  CHECK(same.largestByChance(50, 1) == test.largestByChance(50, 1));
}

TEST_CASE("a direction that changes nothing is no candidate's, and has no size") {
  const Rig rig({}, 200.0, 1);
  const Eigen::MatrixXd nothing = Eigen::MatrixXd::Zero(rig.size(), 1);
  const FitState state = rig.stateOf(blockNoise(rig.data, 2), 1.0);
  const ScoreTest test(rig.fitter, state, nothing);
  CHECK(test.score(0) == 0.0);
  CHECK(test.size(0) == 0.0);
  CHECK(test.promise(0) == 0.0);
  CHECK(test.uniqueness(0) == 0.0);
  CHECK(test.activeBlocks(0) == 0.0);
  CHECK(test.sparseScore(0, 1.0) == 0.0);
  CHECK(std::isinf(test.sizeError(0)));
  CHECK(test.usualOverdispersion() == 1.0);
  for (const double largest : test.largestByChance(20, 1)) CHECK(largest == 0.0);
  const ScoreTest none(rig.fitter, state, Eigen::MatrixXd(rig.size(), 0));
  CHECK(none.candidates() == 0);
  CHECK(none.usualOverdispersion() == 1.0);
  CHECK(none.largestByChance(3, 1) == std::vector<double>(3, 0.0));
}

TEST_CASE("uniqueness is the sine of the angle to what the free parameters can do") {
  const Rig rig({}, 200.0, 1);
  Eigen::MatrixXd axes = waves(rig.data, 2);  // two channels: at a right angle
  axes.colwise().normalize();
  FitState state = rig.stateOf(blockNoise(rig.data, 1), 0.5);
  state.free.push_back(freeParameter(state.model, "yaw_pull.pull"));
  state.jacobian = 30.0 * axes.col(0);
  const double angles[] = {0.1, 0.5, 1.0, 1.5};
  Eigen::MatrixXd directions(rig.size(), 4);
  for (Eigen::Index c = 0; c < 4; ++c)
    directions.col(c) = std::cos(angles[c]) * axes.col(0) + std::sin(angles[c]) * axes.col(1);
  const ScoreTest test(rig.fitter, state, directions);
  for (Eigen::Index c = 0; c < 4; ++c) {
    CHECK(test.uniqueness(c) == Approx(std::sin(angles[c])).epsilon(1e-4));
    CHECK(test.own(c).dot(axes.col(0)) == Approx(0.0).margin(1e-6));
  }
  CHECK(test.score(1) == Approx(test.score(3)));  // their remainders are equal
}

TEST_CASE("chance gives every pattern of signs of the blocks equally often") {
  const Rig rig({}, 100.0, 1);
  const int blocks = rig.data.blocks();
  REQUIRE(blocks == 5);
  const Eigen::MatrixXd direction = waves(rig.data, 1);
  const Eigen::VectorXd residuals = blockNoise(rig.data, 6);
  const ScoreTest test(rig.fitter, rig.stateOf(residuals, 1.0), direction);
  std::vector<double> pulls(5, 0.0);
  for (Eigen::Index i = 0; i < residuals.size(); ++i)
    pulls[static_cast<size_t>(rig.data.all()[static_cast<size_t>(i)].block)] +=
        pullOf(residuals[i], 1.0) * direction(i, 0);
  std::vector<double> exact;
  for (unsigned signs = 0; signs < 32; ++signs) {
    double sum = 0.0;
    double squares = 0.0;
    for (size_t b = 0; b < 5; ++b) {
      sum += (signs >> b & 1U) != 0U ? pulls[b] : -pulls[b];
      squares += pulls[b] * pulls[b];
    }
    exact.push_back(std::abs(sum) / std::sqrt(squares));
  }
  constexpr int kMany = 8000;
  const std::vector<double> drawn = test.largestByChance(kMany, 3);
  REQUIRE(drawn.size() == kMany);
  CHECK(std::is_sorted(drawn.begin(), drawn.end()));
  for (const double level : exact) {
    const auto above = [level](const std::vector<double>& all) {
      return static_cast<double>(std::count_if(
                 all.begin(), all.end(), [level](double value) { return value > level + 1e-9; })) /
             static_cast<double>(all.size());
    };
    CHECK(above(drawn) == Approx(above(exact)).margin(4.0 * std::sqrt(0.25 / kMany)));
  }
}

TEST_CASE("candidates that are the same one do not count twice, different ones do") {
  const Rig rig({}, 400.0, 1);
  const FitState state = rig.stateOf(blockNoise(rig.data, 8), 1.0);
  const Eigen::MatrixXd many = waves(rig.data, kCandidates);
  const Eigen::MatrixXd one = many.col(0);
  const Eigen::MatrixXd copies = one.replicate(1, kCandidates);
  const std::vector<double> alone = ScoreTest(rig.fitter, state, one).largestByChance(kDraws, 5);
  const std::vector<double> copied =
      ScoreTest(rig.fitter, state, copies).largestByChance(kDraws, 5);
  const std::vector<double> different =
      ScoreTest(rig.fitter, state, many).largestByChance(kDraws, 5);
  for (size_t i = 0; i < alone.size(); ++i) {
    CHECK(copied[i] == Approx(alone[i]).margin(1e-12));
    CHECK(different[i] >= alone[i] - 1e-12);
  }
  CHECK(criticalScore(different, kLevel) > criticalScore(alone, kLevel) + 0.3);
}

TEST_CASE("the same seed draws the same chance, another one another") {
  const Rig rig({}, 200.0, 1);
  const ScoreTest test(rig.fitter, rig.stateOf(blockNoise(rig.data, 8), 1.0), waves(rig.data, 3));
  CHECK(test.largestByChance(99, 4) == test.largestByChance(99, 4));
  CHECK(test.largestByChance(99, 4) != test.largestByChance(99, 5));
  CHECK(test.largestByChance(0, 4).empty());
}

TEST_CASE("blocks that share their noise scatter more than the scales say, others hardly do") {
  const Rig rig({}, 400.0, 1);
  Eigen::MatrixXd steady = Eigen::MatrixXd::Zero(rig.size(), 4);
  for (Eigen::Index i = 0; i < steady.rows(); ++i)
    steady(i, static_cast<Eigen::Index>(rig.data.all()[static_cast<size_t>(i)].channel)) = 1.0;
  const auto usual = [&](double share) {
    return ScoreTest(rig.fitter, rig.stateOf(blockNoise(rig.data, 9, share), 1.0), steady)
        .usualOverdispersion();
  };
  CHECK(usual(0.0) < 2.0);
  CHECK(usual(0.5) > 5.0);
  const ScoreTest test(rig.fitter, rig.stateOf(blockNoise(rig.data, 9), 1.0), steady);
  for (Eigen::Index c = 0; c < 4; ++c) {
    CHECK(test.overdispersion(c) >= 1.0);
    CHECK(std::abs(test.sparseScore(c, 1e3)) < std::abs(test.sparseScore(c, 1.0)) + 1e-12);
    CHECK(test.ownScore(c) == test.sparseScore(c, 1.0));
  }
}

TEST_CASE("a p value falls with the score, and what chance reaches with alpha is critical") {
  std::vector<double> chance;
  for (int i = 1; i <= 999; ++i) chance.push_back(0.01 * i);
  double last = 1.0;
  for (double score = 0.0; score < 11.0; score += 0.05) {
    const double p = familyWise(chance, score);
    CHECK(p <= last);
    CHECK(p >= 1.0 / 1000.0);
    CHECK(familyWise(chance, -score) == p);
    last = p;
  }
  for (const double alpha : {0.01, 0.02, 0.05, 0.2})
    CHECK(familyWise(chance, criticalScore(chance, alpha)) <= alpha + 1e-9);
  CHECK(familyWise({}, 3.0) == 1.0);
}

TEST_CASE("the chance of a size is a normal tail times the number of candidates") {
  CHECK(chanceOfSize(1.0, 1) == Approx(chanceBeyond(3.9)));
  CHECK(chanceOfSize(1.0, 70) == Approx(70.0 * chanceBeyond(3.9)));
  CHECK(chanceOfSize(1.2, 70, true) == Approx(70.0 * chanceBeyond(1.2 * 3.3)));
  CHECK(chanceOfSize(0.0, 1) == 1.0);
}

namespace {

/// A state with one held number that explains the first wave: it is `off` from its known value.
FitState heldState(const Rig& rig, const Eigen::VectorXd& residuals, double off, double deviation) {
  FitState state = rig.stateOf(residuals, 1.0);
  state.free.push_back(freeParameter(state.model, "yaw_pull.pull"));
  state.free[0].expected = 0.0;
  state.free[0].deviation = deviation;
  *findParameter(state.model, "yaw_pull.pull") = off;
  state.jacobian = waves(rig.data, 1);
  return state;
}

}  // namespace

TEST_CASE("a direction that a held number imitates shows in how far that number went") {
  const Rig rig({}, 200.0, 1);
  const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(rig.size());
  const Eigen::MatrixXd same = waves(rig.data, 1);
  // Without residuals the score comes from the prior alone.
  CHECK(ScoreTest(rig.fitter, heldState(rig, nothing, 0.0, 0.1), same).score(0) == 0.0);
  const ScoreTest gone(rig.fitter, heldState(rig, nothing, 0.5, 0.1), same);
  CHECK(gone.score(0) == Approx(2.5));
  CHECK(gone.size(0) > 0.0);
  CHECK(ScoreTest(rig.fitter, heldState(rig, nothing, -0.5, 0.1), same).score(0) == Approx(-2.5));
}

TEST_CASE("a model as wrong as it says of itself is no effect", "[statistics]") {
  const Rig rig({}, 400.0, 1);
  const Eigen::MatrixXd wave = waves(rig.data, kCandidates);
  Eigen::MatrixXd directions = wave;
  for (Eigen::Index i = 1; i < directions.cols(); ++i) directions.col(i) += 2.0 * wave.col(0);
  constexpr double kDeviation = 0.1;
  const double weight = weightOf(0.0, 1.0);
  const double information = weight * wave.col(0).squaredNorm();
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0.0, kDeviation);
  int false_alarms = 0;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Eigen::VectorXd residuals =
        blockNoise(rig.data, seed, 0.1) + normal(random) * wave.col(0);
    const double fitted =
        weight * wave.col(0).dot(residuals) / (information + 1.0 / (kDeviation * kDeviation));
    const FitState state = heldState(rig, residuals - fitted * wave.col(0), fitted, kDeviation);
    const ScoreTest test(rig.fitter, state, directions);
    if (familyWise(test.largestByChance(kDraws, seed), largestScore(test)) <= kLevel)
      ++false_alarms;
  }
  CHECK(false_alarms <= 20);
}
