// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <random>

#include <catch2/catch.hpp>

#include "tests/helpers.hpp"
#include "tools/lab/experiment/tables.hpp"
#include "tools/lab/experiment/trials.hpp"

namespace tread::experiment {
namespace {

using tread::testing::effort;

/// Paired trials: the mean error of rule 0 is 0.2 of the distance, that of rule 1 is 0.8 of rule
/// 0's. Repetitions of a run share part of their error.
RatioMoments trials(uint64_t seed, int runs, double shared = 0.3) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> standard;
  RatioMoments moments(2);
  for (int i = 0; i < runs; ++i) {
    RatioMoments run(2);
    const double common = shared * standard(random), other = shared * standard(random);
    for (int repetition = 0; repetition < 10; ++repetition) {
      const double covered = 6.0 + 0.3 * standard(random);
      const double first = 1.2 + common + 0.4 * standard(random);
      const double errors[] = {first, 0.8 * first + 0.25 * (other + 0.4 * standard(random))};
      run.add(covered, errors);
    }
    moments.addRun(run);
  }
  return moments;
}

bool holds(const Estimate& estimate, double truth) {
  return estimate.low <= truth && truth <= estimate.high;
}

}  // namespace

TEST_CASE("a 99 per cent interval covers the truth about 99 times of 100, also where runs differ") {
  const int experiments = effort(2000);
  int errors = 0, ratios = 0;
  for (int i = 0; i < experiments; ++i) {
    const RatioMoments moments = trials(static_cast<uint64_t>(i), 30);
    if (holds(moments.error(0), 0.2)) ++errors;
    if (holds(moments.ratio(1, 0), 0.8)) ++ratios;
  }
  CHECK(errors > 0.98 * experiments);
  CHECK(ratios > 0.98 * experiments);
  CHECK(ratios < experiments);
}

TEST_CASE("pairing makes the interval of a reduction narrow") {
  const RatioMoments moments = trials(1, 300, 0.0);
  const Estimate paired = moments.ratio(1, 0);
  const double relative = (moments.error(1).high - moments.error(1).value) / moments.error(1).value;
  CHECK(paired.high - paired.value < 0.6 * relative * paired.value);
}

TEST_CASE("repetitions of all runs count, and one run has no interval") {
  const RatioMoments many = trials(1, 100, 0.0);
  CHECK(many.repetitions() == 1000.0);
  CHECK(many.deviation(0) == Approx(0.4 / 6.0).epsilon(0.1));
  CHECK(trials(1, 1).error(0).value > 0.0);
  CHECK(std::isnan(trials(1, 1).error(0).low));
}

TEST_CASE("a histogram counts what is in its reach, and nothing else") {
  Histogram bins{0.1, std::vector<double>(3, 0.0)};
  for (const double value : {0.0, 0.05, 0.25, 0.31, 1e9}) bins.add(value);
  bins.add(std::numeric_limits<double>::quiet_NaN());
  bins.add(std::numeric_limits<double>::infinity());
  CHECK(bins.counts == std::vector<double>{2.0, 0.0, 1.0});
}

TEST_CASE("Student's quantile falls to the normal one") {
  CHECK(student99(2) == Approx(63.657));
  CHECK(student99(20) == Approx(2.861));
  CHECK(student99(30) > student99(31));
  CHECK(student99(100000) == Approx(2.5758).epsilon(1e-4));
}

TEST_CASE("several sets of recordings become a mean, its interval and the deviation between them") {
  const auto recordingsWith = [](double value) {
    Tables tables;
    Row row;
    row.estimate = {value, value - 1.0, value + 1.0};
    tables.errors = {row};
    return tables;
  };
  const Row row =
      combined({recordingsWith(1.0), recordingsWith(2.0), recordingsWith(3.0)}).errors.front();
  CHECK(row.estimate.value == Approx(2.0));
  CHECK(row.spread == Approx(1.0));
  CHECK(row.estimate.high - row.estimate.value == Approx(9.925 / std::sqrt(3.0)));
  const Row alone = combined({recordingsWith(5.0)}).errors.front();
  CHECK(alone.estimate.high == 6.0);
  CHECK(std::isnan(alone.spread));
}

}  // namespace tread::experiment
