// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include "modules/identification/core/likelihood.hpp"

using namespace tread;
using namespace tread::gap;

namespace {

/// Two-sided tail probability of Student's distribution at t, in closed form for integer degrees of
/// freedom (Abramowitz and Stegun 26.7.3 and 26.7.4).
double studentBeyond(double t, int freedom) {
  const double theta = std::atan(t / std::sqrt(freedom));
  const double c2 = std::cos(theta) * std::cos(theta);
  const bool even = freedom % 2 == 0;
  double term = even ? 1.0 : std::cos(theta);
  double sum = freedom == 1 ? 0.0 : term;
  for (int k = even ? 2 : 3; k <= freedom - 2; k += 2) {
    term *= c2 * (k - 1.0) / k;
    sum += term;
  }
  const double within = even ? std::sin(theta) * sum : 2.0 / kPi * (theta + std::sin(theta) * sum);
  return 1.0 - within;
}

/// Rows of one channel after the other; along and across alternate, as in Observations.
std::vector<Observation> rowsOf(size_t count) {
  std::vector<Observation> rows(count);
  for (size_t i = 0; i < count; ++i) rows[i].channel = static_cast<ObservedRate>(i % kChannels);
  return rows;
}

/// Residuals of known noise, with the activity at which they were drawn.
struct Drawn {
  explicit Drawn(const Noise& noise, size_t count = 8000) : rows(rowsOf(count)) {
    std::mt19937_64 random(11);
    std::student_t_distribution<double> student(kFreedom);
    std::uniform_real_distribution<double> uniform(0.0, 2.0);
    residuals.resize(static_cast<Eigen::Index>(count));
    activity.resize(residuals.size());
    for (size_t i = 0; i < count; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const ChannelNoise& of = noise[i % kChannels];
      activity[at] = uniform(random);
      residuals[at] = std::hypot(of.still, of.share * activity[at]) * student(random);
    }
    mask.assign(count, 1);
  }

  double negativeLogLikelihood(const Noise& noise) const {
    const Eigen::VectorXd scales = scalesOf(rows, noise, activity);
    return totalLoss(residuals, scales, mask) + scales.array().log().sum();
  }

  std::vector<Observation> rows;
  Eigen::VectorXd residuals;
  Eigen::VectorXd activity;
  std::vector<char> mask;
};

const Noise kKnown{ChannelNoise{0.02, 0.1}, {0.01, 0.05}, {0.03, 0.02}, {0.01, 0.1}};

}  // namespace

TEST_CASE("the loss is the negative logarithm of Student's density with four degrees of freedom") {
  // Its integral is root(4) B(1/2, 2) = 8/3 times the scale.
  constexpr double kScale = 0.3;
  constexpr double kStep = 1e-3;
  double integral = 0.0;
  for (double r = -60.0; r < 60.0; r += kStep) integral += kStep * std::exp(-lossOf(r, kScale));
  CHECK(integral == Approx(8.0 / 3.0 * kScale).epsilon(1e-4));
  CHECK(lossOf(0.0, kScale) == 0.0);
  CHECK(lossOf(2.0 * kScale, kScale) == Approx(2.5 * std::log(2.0)));
}

TEST_CASE("a loss is even and knows only how many scales a residual is") {
  for (const double r : {1e-4, 0.1, 1.0, 30.0}) {
    CHECK(lossOf(-r, 0.2) == lossOf(r, 0.2));
    CHECK(lossOf(7.0 * r, 1.4) == Approx(lossOf(r, 0.2)));
    CHECK(pullOf(-r, 0.2) == -pullOf(r, 0.2));
  }
}

TEST_CASE("the pull is the slope of the loss, and the weight the pull over the residual") {
  for (const double scale : {0.01, 1.0, 5.0})
    for (const double z : {-20.0, -2.0, -0.3, 0.01, 1.0, 8.0}) {
      const double r = z * scale;
      const double h = 1e-5 * scale;
      const double slope = (lossOf(r + h, scale) - lossOf(r - h, scale)) / (2.0 * h);
      CHECK(pullOf(r, scale) == Approx(slope).epsilon(1e-5));
      CHECK(weightOf(r, scale) * r == Approx(pullOf(r, scale)));
    }
}

TEST_CASE("no residual pulls more than one of two scales: a jump of the INS does not decide") {
  constexpr double kScale = 0.5;
  const double largest = pullOf(2.0 * kScale, kScale);
  CHECK(largest == Approx(1.25 / kScale));
  for (double r = 0.0; r < 1000.0; r = 1.1 * r + 0.01) CHECK(pullOf(r, kScale) <= largest + 1e-12);
  CHECK(pullOf(1000.0, kScale) < 0.01 * largest);
  CHECK(weightOf(0.0, kScale) == Approx(1.25 / (kScale * kScale)));
}

TEST_CASE("Student's 97.5 percent quantile is that of the tables") {
  const std::pair<double, double> table[] = {
      {4.0, 2.776445},  {5.0, 2.570582},  {6.0, 2.446912},  {8.0, 2.306004},  {9.0, 2.262157},
      {10.0, 2.228139}, {15.0, 2.131450}, {20.0, 2.085963}, {30.0, 2.042272}, {100.0, 1.983972}};
  for (const auto& [freedom, quantile] : table) {
    INFO(freedom << " degrees of freedom");
    CHECK(studentQuantile(freedom) == Approx(quantile).epsilon(0.005));
  }
  CHECK(studentQuantile(3.0) == Approx(3.182446).epsilon(0.008));
}

TEST_CASE("Student's quantile is exceeded with the chance of the normal one") {
  // the oracle compared with tables
  CHECK(studentBeyond(2.776445, 4) == Approx(0.05).epsilon(1e-5));
  CHECK(studentBeyond(2.570582, 5) == Approx(0.05).epsilon(1e-5));
  for (int freedom = 3; freedom <= 60; ++freedom) {
    INFO(freedom << " degrees of freedom");
    CHECK(studentBeyond(studentQuantile(freedom), freedom) == Approx(0.05).epsilon(0.03));
  }
  const double rare = studentBeyond(studentQuantile(8, normalQuantileOf(1e-4)), 8);
  CHECK(rare == Approx(1.1e-4).epsilon(0.03));  // too large by 10 %
  for (int freedom = 12; freedom <= 60; ++freedom)
    CHECK(studentBeyond(studentQuantile(freedom, 3.3), freedom) ==
          Approx(chanceBeyond(3.3)).epsilon(0.05));
}

TEST_CASE(
    "Student's quantile falls to the normal one, and less than three degrees count as three") {
  double last = studentQuantile(3.0);
  for (double freedom = 4.0; freedom < 1e4; freedom *= 1.5) {
    CHECK(studentQuantile(freedom) < last);
    last = studentQuantile(freedom);
    CHECK(last > kNormal975);
  }
  CHECK(studentQuantile(1e9) == Approx(kNormal975));
  for (const double few : {2.0, 1.0, 0.0, -1.0})
    CHECK(studentQuantile(few) == studentQuantile(3.0));
}

TEST_CASE("normal quantiles and chances are those of the tables and each other's inverse") {
  CHECK(chanceBeyond(0.0) == 1.0);
  CHECK(chanceBeyond(kNormal975) == Approx(0.05).epsilon(1e-5));
  CHECK(chanceBeyond(2.575829) == Approx(0.01).epsilon(1e-5));
  CHECK(chanceBeyond(3.290527) == Approx(0.001).epsilon(1e-5));
  for (const double chance : {0.9, 0.3173, 0.05, 1e-3, 1e-9, 1e-200})
    CHECK(chanceBeyond(normalQuantileOf(chance)) == Approx(chance).epsilon(1e-6));
  CHECK(normalQuantileOf(1.0) == Approx(0.0).margin(1e-9));
  CHECK(std::isfinite(normalQuantileOf(0.0)));
  CHECK(normalQuantileOf(0.0) > 30.0);
}

TEST_CASE("activity is the size of the yaw rate or the speed over both axes") {
  const std::vector<Observation> rows = rowsOf(8);
  Eigen::VectorXd predicted(8);
  predicted << -0.4, 0.5, 3.0, -4.0, 0.0, -0.7, -5.0, 12.0;
  Eigen::VectorXd expected(8);
  expected << 0.4, 0.5, 5.0, 5.0, 0.0, 0.7, 13.0, 13.0;
  CHECK((activityOf(rows, predicted) - expected).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("scales add what stands still and the share of the motion by squares") {
  const std::vector<Observation> rows = rowsOf(4);
  const Noise noise{ChannelNoise{3.0, 0.0}, {0.0, 2.0}, {3.0, 4.0}, {5.0, 12.0}};
  Eigen::VectorXd expected(4);
  expected << 3.0, 2.0, 5.0, 13.0;
  const Eigen::VectorXd scales = scalesOf(rows, noise, Eigen::VectorXd::Ones(4));
  CHECK((scales - expected).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("the noise that residuals were drawn from is estimated, each channel by itself") {
  const Drawn drawn(kKnown);
  const Noise found = estimateNoise(drawn.rows, drawn.residuals, drawn.activity, drawn.mask);
  for (size_t c = 0; c < kChannels; ++c) {
    INFO(channelName(static_cast<ObservedRate>(c)));
    // At medium activity both parts are estimated together, better than each alone.
    CHECK(std::hypot(found[c].still, found[c].share) ==
          Approx(std::hypot(kKnown[c].still, kKnown[c].share)).epsilon(0.06));
    CHECK(found[c].still == Approx(kKnown[c].still).epsilon(0.3));
    CHECK(found[c].share == Approx(kKnown[c].share).epsilon(0.3));
  }
}

TEST_CASE("no noise nearby makes the residuals likelier than the estimate") {
  const Drawn drawn(kKnown, 2000);
  const Noise found = estimateNoise(drawn.rows, drawn.residuals, drawn.activity, drawn.mask);
  const double least = drawn.negativeLogLikelihood(found);
  for (size_t c = 0; c < kChannels; ++c)
    for (const double still : {0.8, 0.95, 1.0, 1.05, 1.25})
      for (const double share : {0.8, 0.95, 1.0, 1.05, 1.25}) {
        Noise other = found;
        other[c].still *= still;
        other[c].share *= share;
        CHECK(drawn.negativeLogLikelihood(other) > least - 0.1);
      }
}

TEST_CASE("noise is told in the unit of the residuals") {
  Drawn drawn(kKnown, 2000);
  const Noise once = estimateNoise(drawn.rows, drawn.residuals, drawn.activity, drawn.mask);
  drawn.residuals *= 50.0;
  const Noise large = estimateNoise(drawn.rows, drawn.residuals, drawn.activity, drawn.mask);
  for (size_t c = 0; c < kChannels; ++c) {
    CHECK(large[c].still == Approx(50.0 * once[c].still).epsilon(1e-3));
    CHECK(large[c].share == Approx(50.0 * once[c].share).epsilon(1e-3));
  }
}

TEST_CASE("rows whose mask is 0 change neither the noise nor the loss, whatever they say") {
  Drawn drawn(kKnown, 2000);
  for (size_t i = 0; i < drawn.mask.size(); i += 3) drawn.mask[i] = 0;
  const Noise before = estimateNoise(drawn.rows, drawn.residuals, drawn.activity, drawn.mask);
  const Eigen::VectorXd scales = scalesOf(drawn.rows, before, drawn.activity);
  const double loss = totalLoss(drawn.residuals, scales, drawn.mask);
  for (size_t i = 0; i < drawn.mask.size(); i += 3)
    drawn.residuals[static_cast<Eigen::Index>(i)] = i % 2 == 0 ? kNotMeasured : 1e9;
  const Noise after = estimateNoise(drawn.rows, drawn.residuals, drawn.activity, drawn.mask);
  for (size_t c = 0; c < kChannels; ++c) {
    CHECK(after[c].still == before[c].still);
    CHECK(after[c].share == before[c].share);
  }
  CHECK(totalLoss(drawn.residuals, scales, drawn.mask) == loss);
}

TEST_CASE("residuals that are all 0 have a scale, and a channel without rows keeps its own") {
  const std::vector<Observation> rows(40);  // for the yaw rate
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(40);
  const Noise noise = estimateNoise(rows, zero, zero, std::vector<char>(40, 1));
  CHECK(noise[0].still > 0.0);
  CHECK(std::isfinite(noise[0].still));
  CHECK(scalesOf(rows, noise, zero).minCoeff() > 0.0);
  for (size_t c = 1; c < kChannels; ++c) {
    CHECK(noise[c].still == ChannelNoise{}.still);
    CHECK(noise[c].share == ChannelNoise{}.share);
  }
  const Noise none = estimateNoise(rows, zero, zero, std::vector<char>(40, 0));
  CHECK(none[0].still == ChannelNoise{}.still);
}
