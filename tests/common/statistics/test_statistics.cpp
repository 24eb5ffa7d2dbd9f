// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <vector>

#include "common/statistics/statistics.hpp"

using namespace tread;

TEST_CASE("the median of an even number is between the middle ones, of nothing none") {
  CHECK(medianOf({3.0, 1.0, 2.0}) == 2.0);
  CHECK(medianOf({4.0, 1.0, 2.0, 3.0}) == 2.5);
  CHECK(std::isnan(medianOf({})));
  CHECK(medianOf({}, 7.0) == 7.0);
}

TEST_CASE("the upper median is a value of the series") {
  CHECK(upperMedian(std::vector<int64_t>{4, 1, 2, 3}) == 3);
  CHECK(upperMedian(std::vector<int64_t>{}) == 0);
  CHECK(std::isnan(upperMedian(std::vector<double>{}, kNoFigure)));
}

TEST_CASE("quantiles are values of the series, of the nearest rank or of the one below") {
  const std::vector<double> series{5.0, 1.0, 4.0, 2.0, 3.0};
  CHECK(quantileOf(series, 0.0) == 1.0);
  CHECK(quantileOf(series, 0.5) == 3.0);
  CHECK(quantileOf(series, 0.95) == 5.0);
  CHECK(lowerQuantile(series, 0.95) == 4.0);
  CHECK(lowerQuantile(series, 1.0) == 5.0);
  CHECK(quantileOf({}, 0.5, 1.0) == 1.0);
  CHECK(std::isnan(lowerQuantile({}, 0.5)));
}

TEST_CASE("mean and root of the mean square") {
  CHECK(meanOf({1.0, 2.0, 6.0}) == 3.0);
  CHECK(rmsOf({3.0, -4.0, 0.0, 5.0}) == Approx(std::sqrt(12.5)));
  CHECK(std::isnan(meanOf({})));
  CHECK(rmsOf({}, 0.0) == 0.0);
}
