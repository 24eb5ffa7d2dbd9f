// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <functional>
#include <limits>

#include <catch2/catch.hpp>

#include "core_rig.hpp"
#include "modules/identification/core/screening.hpp"

using namespace tread;
using namespace tread::gap;
using samples::Rig;

namespace {

Candidate limitOf(double inverse) {
  Candidate candidate;
  candidate.effect = "turn_power_limit";
  candidate.parameter = "inverse_limit";
  candidate.value = inverse;
  candidate.change = inverse;
  return candidate;
}

/// Sizes with a score.
std::function<double(size_t)> sizesAt(const ScoreTest& test, double score) {
  return [&test, score](size_t i) { return score * test.sizeError(static_cast<Eigen::Index>(i)); };
}

}  // namespace

TEST_CASE("of a limit the gentlest one that shows is what would have been seen") {
  const Rig rig({}, 200.0, 3);
  const Eigen::VectorXd wave = samples::waves(rig.data, 1).col(0);
  // The lower the limit, the larger the affected part of a drive.
  Eigen::MatrixXd directions(rig.size(), 3);
  directions << 0.01 * wave, 2.0 * wave, 3.0 * wave;
  const std::vector<Candidate> limits{limitOf(0.5), limitOf(1.0), limitOf(2.0)};
  const ScoreTest test(rig.fitter, rig.stateOf(samples::blockNoise(rig.data, 5, 0.1), 1.0),
                       directions);
  const double needed = 1.1 / std::max(test.sizeError(1), test.sizeError(2) / 2.0) /* in between */;
  REQUIRE(0.5 < 0.9 * test.sizeError(0) / test.sizeError(1));
  for (size_t i : {0U, 1U, 2U}) {
    CHECK(detectableSize(limits, sizesAt(test, 0.8 * needed), i) == 1.0);
    CHECK(detectableSize(limits, sizesAt(test, 100.0 * needed), i) ==
          std::numeric_limits<double>::infinity());
  }
}

TEST_CASE("an effect without a threshold is visible from a size that falls with its error") {
  const Rig rig({}, 200.0, 3);
  Candidate slip;
  slip.effect = "slip_ratio";
  slip.parameter = "slip";
  slip.change = 0.02;
  const ScoreTest test(rig.fitter, rig.stateOf(samples::blockNoise(rig.data, 5, 0.1), 1.0),
                       samples::waves(rig.data, 1));
  CHECK(detectableSize({slip}, sizesAt(test, 3.0), 0) == Approx(3.0 * test.sizeError(0)));
}
