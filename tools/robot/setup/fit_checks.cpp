// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/setup/fit_checks.hpp"

#include <algorithm>
#include <cmath>

#include "common/report/text.hpp"
#include "tools/robot/launch/checks.hpp"

namespace tread::setup {
namespace {

constexpr double kLeastRate = 10.0;      // [Hz] of the INS
constexpr double kMostDead = 0.35;       // [1]
constexpr double kMostDelay = 0.5;       // [s]
constexpr double kWatchdogSlack = 0.35;  // [s] for the INS to detect the stop

}  // namespace

std::vector<FitCheck> checkFit(const SetupResult& result) {
  const RobotFindings& found = result.findings;
  const commissioning::WiringReport& wiring = found.wiring;
  const RobotDescription& robot = found.robot;
  std::vector<FitCheck> checks;
  const auto check = [&](bool good, const std::string& words, const std::string& remedy) {
    checks.push_back({good, good ? words : words + "; " + remedy});
  };
  check(found.ins.rate >= kLeastRate, "the INS measures at " + fixed(found.ins.rate, 0) + " Hz",
        "set it to 20 Hz or more: the motor bridge stops without it");
  check(found.has_attitude,
        found.has_attitude ? "the INS measures roll and pitch: tilt is watched"
                           : "the INS does not measure roll and pitch",
        "tilt cannot be watched, and slopes are unknown");
  const double silence = result.ground.watchdog;
  const double allowed =
      found.watchdog + wiring.delay.high + 3.0 * wiring.lag.high + kWatchdogSlack;
  check(silence > 0.0 && silence < allowed,
        "after the line falls silent it stands within " + fixed(silence, 2) + " s (watchdog " +
            fixed(found.watchdog, 2) + " s)",
        "set up the controller's watchdog");
  check(wiring.delay.value < kMostDelay,
        "a command takes " + fixed(wiring.delay.value, 2) + " s to its effect in the INS",
        "look at the INS's latency and its line's rate");
  check(wiring.dead_power.value < kMostDead,
        "commands up to " + fixed(100.0 * wiring.dead_power.value, 0) + " % move nothing",
        "look at brakes and chains");
  check(robot.footprint.front >= robot.outline.front &&
            robot.footprint.half_width >= robot.outline.half_width,
        "plans keep free " +
            fixed(100.0 * (robot.footprint.half_width - robot.outline.half_width), 0) +
            " cm more than its body",
        "make footprint larger than outline");
  const double stopping = robot.stopping_time * robot.drive.full_speed;
  check(stopping < 0.5 * found.marking_range,
        "from full speed it stops within " + fixed(stopping, 1) + " m, obstacles are marked to " +
            fixed(found.marking_range, 1) + " m",
        "drive slower, or raise marking_range of mapping.yaml");
  check(found.marking_range <= found.range,
        "the range finder sees to " + fixed(found.range, 1) + " m", "lower marking_range");
  check(found.beams_that_tell > kLeastTelling,
        fixed(100.0 * found.beams_that_tell, 0) + " % of its beams gave a result where it stood",
        "the planner drives only where it knows the ground to be free: begin with more objects "
        "within "
        "its range, or configure the driver so that no echo means clear");
  if (!result.recorded) return checks;
  const auto reach = launch::checkReach(result.recorded->patterns, found.marking_range);
  check(reach.empty(),
        reach.empty() ? "all patterns end within the marking range" : reach.front().problem,
        reach.empty() ? "" : reach.front().remedy);
  return checks;
}

}  // namespace tread::setup
