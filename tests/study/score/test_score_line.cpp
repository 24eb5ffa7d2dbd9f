// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/study/score/score_files.hpp"

using namespace tread::blindtest;

namespace {

ScoreLine share(size_t hits, size_t cases, const Must& must) {
  ScoreLine line;
  line.hits = hits;
  line.cases = cases;
  line.must = must;
  setShare(line);
  return line;
}

}  // namespace

TEST_CASE("a share has Wilson's interval") {
  const ScoreLine line = share(9, 10, {});
  CHECK(line.value == Approx(0.9));
  CHECK(line.low == Approx(0.596).margin(0.001));
  CHECK(line.high == Approx(0.982).margin(0.001));
}

TEST_CASE("a quantile lies between its neighbours") {
  CHECK(quantile({3.0, 1.0, 2.0, 4.0}, 0.5) == Approx(2.5));
  CHECK(quantile({1.0, 2.0}, 0.1) == Approx(1.1));
  CHECK(std::isnan(quantile({}, 0.5)));
}

TEST_CASE("the interval of a median is that of the sign test, and open with too few values") {
  std::vector<double> values;
  for (int i = 1; i <= 20; ++i) values.push_back(i);
  ScoreLine line;
  setQuantile(line, values, 0.5);
  // 6th and 15th of 20: the classical table.
  CHECK(line.low == 6.0);
  CHECK(line.high == 15.0);
  CHECK(line.cases == 20);
  CHECK_FALSE(line.is_share);
  setQuantile(line, {1.0, 2.0, 3.0}, 0.5);
  CHECK(std::isinf(line.low));
  CHECK(std::isinf(line.high));
}

TEST_CASE("what must be is met or not where the whole interval says so, else it is open") {
  const Must least{0.9};
  CHECK(share(100, 100, least).met() == Met::kYes);
  CHECK(share(38, 40, least).met() == Met::kOpen);
  CHECK(share(34, 40, least).met() == Met::kOpen);
  CHECK(share(20, 40, least).met() == Met::kNo);
  CHECK(metWords(share(38, 40, least)) == "cannot be decided with 40 (value met)");
  CHECK(metWords(share(34, 40, least)) == "cannot be decided with 40 (value not met)");
  const Must most{0.03, false};
  CHECK(share(0, 200, most).met() == Met::kYes);
  CHECK(share(0, 20, most).met() == Met::kOpen);
  CHECK(share(5, 20, most).met() == Met::kNo);
  CHECK_FALSE(share(0, 0, most).met().has_value());
  CHECK(metWords(share(0, 0, most)) == "no case");
}

TEST_CASE("a must with an upper end is open while there are too few cases") {
  const Must must{0.05, false, {}, 0.08, 400};
  CHECK(share(0, 10, must).met() == Met::kOpen);
  CHECK(share(0, 399, must).met() == Met::kOpen);
  CHECK(share(8, 400, must).met() == Met::kYes);
  CHECK(share(4, 20, must).met() == Met::kNo);
}

TEST_CASE("a share that must lie between two values is met inside and not met on either side") {
  const Must must{0.90, true, 0.98};
  CHECK(share(1880, 2000, must).met() == Met::kYes);
  CHECK(share(1600, 2000, must).met() == Met::kNo);
  CHECK(share(2000, 2000, must).met() == Met::kNo);
  CHECK(share(19, 20, must).met() == Met::kOpen);
}

TEST_CASE("what must always be is decided by a single case") {
  CHECK(share(3, 3, Must{1.0}).met() == Met::kYes);
  CHECK(share(2, 3, Must{1.0}).met() == Met::kNo);
}
