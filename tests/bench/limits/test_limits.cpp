// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "tests/bench/limits/limit_run.hpp"

using namespace tread;
using namespace tread::limits;

namespace {

const missions::RobotConfig& teodor() {
  static const missions::RobotConfig robot =
      missions::readRobot(TREAD_SOURCE_DIR "/config/robots/teodor");
  return robot;
}

LimitRun drive(uint64_t seed, Kind kind, const LimitOptions& options = {}) {
  return runLimits(teodor(), seed, limitWorld(seed, kind, teodor().simulated.vehicle.outline),
                   options);
}

}  // namespace

TEST_CASE("a few missions among fences: the true outline crosses none of them") {
  int drove = 0;
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    const LimitRun run = drive(seed, Kind::kFences);
    CHECK(run.least_room >= 0.0);
    CHECK(run.farther_out <= 0.1);
    drove += run.drove ? 1 : 0;
  }
  CHECK(drove >= 10);
}

TEST_CASE(
    "without both looks at the fences some of these missions cross one: the referee sees it") {
  LimitOptions blind;
  blind.bridge_watches = blind.planner_keeps_off = false;
  int crossed = 0;
  for (uint64_t seed = 1; seed <= 4; ++seed)
    crossed += drive(seed, Kind::kFences, blind).least_room < 0.0 ? 1 : 0;
  CHECK(crossed > 0);
}

TEST_CASE("between hills and pits it never tilts beyond its hard limit") {
  // The first of these once stopped on a slope and slid down into a pit.
  LimitOptions half_a_minute;
  half_a_minute.seconds = 30.0;
  for (const uint64_t seed : {259, 456, 963, 1, 14, 19}) {
    CAPTURE(seed);
    const LimitRun run = drive(seed, Kind::kSlopes, half_a_minute);
    CHECK(run.drove);
    CHECK(run.tilt < teodor().motor_bridge.bridge.tilt->roll);
  }
}
