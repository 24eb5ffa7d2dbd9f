// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "modules/lidar_driver/core/range_scan.hpp"
#include "modules/lidar_driver/core/reasons.hpp"

using namespace tread::lidar;

TEST_CASE("of all reasons the one that tells most is given, with its count, for 5 s") {
  Reasons reasons;
  CHECK(reasons.best(0).rank == Rank::kNone);
  reasons.note(Rank::kStarting, "starting up", 0);
  CHECK(reasons.best(60'000'000).words == "starting up");
  reasons.note(Rank::kUnreadable, "bytes outside of frames", 1'000'000, 3667, "check baud rate");
  reasons.note(Rank::kRefused, "wrong checksums", 1'000'000, 2);
  reasons.note(Rank::kRefused, "another product", 1'000'000, 3, "take another");
  reasons.note(Rank::kSilent, "no answer", 2'000'000);
  reasons.note(Rank::kStarting, "starting up", 2'000'000);
  CHECK(reasons.best(6'000'000).words == "another product (3); take another");
  CHECK(reasons.best(6'000'001).words == "no answer");
  reasons.note(Rank::kUnreadable, "bytes outside of frames", 6'500'000, 1, "check baud rate");
  CHECK(reasons.best(7'000'000).words == "bytes outside of frames (3668); check baud rate");
  reasons.clear();
  CHECK(reasons.best(7'000'000).rank == Rank::kNone);
}

namespace {

RangeScan goodScan(int64_t utime) {
  RangeScan scan;
  scan.utime = utime;
  scan.duration_us = 80'000;
  scan.angle_first = -1.0;
  scan.angle_step = 0.5;
  scan.range_min = 0.02;
  scan.range_max = 30.0;
  scan.ranges = {1.0f, 0.01f, 31.0f, std::numeric_limits<float>::quiet_NaN(), 2.0f};
  return scan;
}

}  // namespace

TEST_CASE("a beam is a range, nothing hit, or no measurement") {
  ScanCheck check({0.1, 20.0, 4000, 1});
  const auto scan = check.accept(goodScan(1));
  REQUIRE(scan);
  REQUIRE(scan->ranges.size() == 5);
  REQUIRE(scan->ranges[0] == 1.0f);
  REQUIRE(std::isnan(scan->ranges[1]));
  REQUIRE(std::isinf(scan->ranges[2]));
  REQUIRE(std::isnan(scan->ranges[3]));
  REQUIRE(scan->range_min == 0.1);
  REQUIRE(scan->range_max == 20.0);
}

TEST_CASE("a stride keeps every n-th beam with its own angle and time") {
  ScanCheck check({0.1, 20.0, 4000, 3});
  const auto scan = check.accept(goodScan(1));
  REQUIRE(scan->ranges.size() == 2);
  REQUIRE(scan->angle_step == 1.5);
  REQUIRE(scan->duration_us == 60'000);
}

TEST_CASE("scans that cannot be are refused with their reason, and good ones after them pass") {
  ScanCheck check({0.1, 20.0, 10, 1});
  const auto refusal = [&](RangeScan scan) {
    REQUIRE_FALSE(check.accept(scan));
    return check.refusal();
  };
  REQUIRE(check.accept(goodScan(100)));
  REQUIRE(refusal(goodScan(100)) == "not newer than the scan before");
  RangeScan bad = goodScan(200);
  bad.ranges.clear();
  REQUIRE(refusal(bad) == "no beams");
  bad = goodScan(200);
  bad.ranges.resize(11);
  REQUIRE(refusal(bad) == "too many beams");
  bad = goodScan(200);
  bad.angle_step = NAN;
  REQUIRE(refusal(bad) == "angles not finite");
  bad = goodScan(200);
  bad.angle_step = 2.0;
  REQUIRE(refusal(bad) == "more than a turn");
  bad = goodScan(200);
  bad.duration_us = -1;
  REQUIRE(refusal(bad) == "duration outside 0..1 s");
  REQUIRE(check.accept(goodScan(200)));
}
