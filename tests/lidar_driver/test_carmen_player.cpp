// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <zlib.h>

#include <cmath>
#include <random>

#include "modules/lidar_driver/carmen/carmen_player.hpp"
#include "tests/helpers.hpp"

using namespace tread::lidar;
using namespace tread::testing;

namespace {

std::string flaser(int beams, double logged) {
  std::string line = "FLASER " + std::to_string(beams);
  for (int i = 0; i < beams; ++i) line += " 2.5";
  return line + " 1 2 0.5 1 2 0.5 0 host " + std::to_string(logged) + "\n";
}

}  // namespace

TEST_CASE("a CARMEN log is played at its own time") {
  CarmenPlayer player({});
  player.open(1'000'000);
  player.receive("# head\nODOM 0 0 0 0 0 0 0 host 0\n" + flaser(181, 10.0) + flaser(181, 10.25) +
                     "FLASER 181 1 2 3\n" + flaser(180, 11.25),
                 1'000'000);
  auto scans = player.take(1'000'000);
  CHECK(scans.empty());
  scans = player.take(10'000'000);
  REQUIRE(scans.size() == 3);
  CHECK(scans[1].utime - scans[0].utime == 250'000);
  CHECK(scans[2].utime - scans[1].utime == 1'000'000);
  CHECK(scans[0].angle_first + 180 * scans[0].angle_step == Approx(M_PI / 2));
  CHECK(scans[2].angle_step == Approx(M_PI / 180));
  CHECK(player.counters().at("lines of a scan that are damaged") == 1);
  CHECK(player.counters().at("other lines") == 2);
  std::string problem;
  const CarmenScan robot = parseCarmenLine(
      "ROBOTLASER1 0 -1.5708 3.1416 1.5708 81.9 0.01 0 3 1 2 3 0 0 0 0 0 0 0 0 0 0.1 0.1 1 5.5 h "
      "5.5",
      problem);
  CHECK(problem.empty());
  CHECK(robot.scan.ranges == std::vector<float>{1, 2, 3});
  CHECK(robot.scan.range_max == 81.9);
  CHECK(*robot.logged == 5.5);
}

TEST_CASE("a million mutated bytes of a CARMEN log neither grow nor break its player") {
  std::mt19937 random(2);
  CarmenPlayer player({});
  int64_t now = 1'000'000;
  player.open(now);
  for (int fed = 0; fed < effort(1'200'000);) {
    std::string line = flaser(180, static_cast<double>(fed));
    for (auto i = random() % 6; i > 0; --i) line[random() % line.size()] = char(random());
    fed += static_cast<int>(line.size());
    now += 10'000'000;
    player.receive(line, now);
    for (const RangeScan& scan : player.take(now)) {
      REQUIRE(scan.ranges.size() <= 4000);
      REQUIRE(scan.utime <= now);
      for (const float range : scan.ranges) REQUIRE(std::isfinite(range));
    }
  }
  CHECK(player.hungry());
  CHECK(player.counters().at("scans read") > effort(100));
  CHECK(player.counters().at("lines of a scan that are damaged") > effort(100));
}

TEST_CASE("the Freiburg log plays: scans in, the rest refused with reasons") {
  const std::string path = recorded("lidar/carmen/freiburg-campus-corrected.log.gz");
  if (path.empty()) {
    WARN("skipped: the Freiburg log is not here (TREAD_RECORDINGS)");
    return;
  }
  CarmenPlayer player({});
  ScanCheck check({0.1, 80.0, 4000, 1});
  gzFile file = gzopen(path.c_str(), "rb");
  REQUIRE(file != nullptr);
  char buffer[65536];
  int64_t now = 1'000'000;
  int accepted = 0;
  player.open(now);
  for (int size = 0; (size = gzread(file, buffer, sizeof buffer)) > 0;) {
    player.receive({buffer, static_cast<size_t>(size)}, now);
    now += 60'000'000;
    for (const RangeScan& scan : player.take(now)) accepted += check.accept(scan).has_value();
  }
  gzclose(file);
  CHECK(accepted == 2008);
  CHECK(player.counters().at("scans read") == 2008);
  CHECK(player.counters().at("scans without a time of their own") == 2008);
  CHECK(player.counters().count("lines of a scan that are damaged") == 0);
}
