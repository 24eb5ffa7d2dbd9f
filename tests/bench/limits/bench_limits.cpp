// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Missions of the whole robot in virtual time, with fences, or with hills and pits.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include <CLI/CLI.hpp>

#include "common/config/command_line.hpp"
#include "common/geometry/degrees.hpp"
#include "tests/bench/limits/limit_run.hpp"

namespace {

using namespace tread;
using namespace tread::limits;

struct Arguments {
  int missions = 100;
  uint64_t seed = 1;
  bool slopes = false;
  bool verbose = false;
  LimitOptions options;
};

void print(uint64_t seed, const LimitWorld& world, const LimitRun& run) {
  std::printf(
      "seed %llu: %s after %.0f s and %.1f m; room %.3f m, farther out %.3f m, tilt %.1f deg; "
      "stops of the bridge: %d fence, %d tilt%s%s%s; %s\n",
      static_cast<unsigned long long>(seed), run.arrived ? "arrived" : "not arrived", run.seconds,
      run.distance, run.least_room, run.farther_out, toDegrees(run.tilt), run.fence_stops,
      run.tilt_stops, world.planner_knows ? "" : "; planner knows no fence",
      world.starts_outside ? "; starts outside" : "", world.surprise_s ? "; surprise" : "",
      run.last_plan.c_str());
  std::fflush(stdout);
}

int drive(const Arguments& arguments) {
  const missions::RobotConfig robot = missions::readRobot(TREAD_CONFIG_DIR "/robots/teodor");
  const Kind kind = arguments.slopes ? Kind::kSlopes : Kind::kFences;
  const TiltLimits hard = robot.motor_bridge.bridge.tilt.value();
  int drove = 0, arrived = 0, breaches = 0, tilted = 0, fence_stops = 0, tilt_stops = 0;
  int outside = 0, back_in = 0;
  double metres = 0.0, least = 1e9, worst = 0.0;
  std::map<std::string, int> ends;
  for (int i = 0; i < arguments.missions; ++i) {
    const uint64_t seed = arguments.seed + static_cast<uint64_t>(i);
    const LimitWorld world = limitWorld(seed, kind, robot.simulated.vehicle.outline);
    const LimitRun run = runLimits(robot, seed, world, arguments.options);
    const bool breach = run.least_room < 0.0 || run.farther_out > 0.1;
    const bool tilt = run.tilt > std::min(hard.roll, hard.pitch);
    if (breach || tilt || arguments.verbose) print(seed, world, run);
    breaches += breach ? 1 : 0;
    tilted += tilt ? 1 : 0;
    drove += run.drove ? 1 : 0;
    arrived += run.arrived ? 1 : 0;
    fence_stops += run.fence_stops > 0 ? 1 : 0;
    tilt_stops += run.tilt_stops > 0 ? 1 : 0;
    outside += world.starts_outside ? 1 : 0;
    back_in += world.starts_outside && run.least_room < 1e8 ? 1 : 0;
    metres += run.distance;
    least = std::min(least, run.least_room);
    worst = std::max(worst, run.tilt);
  }
  // Rule of three: with 95 % confidence.
  std::printf(
      "%d missions, %.0f m: %d over a fence, %d beyond the hard tilt limit (0 of n: below %.2f %% "
      "with 95 %% confidence); %d drove, %d arrived; the bridge stopped %d at a fence and %d by "
      "tilt; least room %.3f m, most tilt %.1f deg; %d started outside, %d of them came in\n",
      arguments.missions, metres, breaches, tilted, 300.0 / arguments.missions, drove, arrived,
      fence_stops, tilt_stops, least < 1e8 ? least : NAN, toDegrees(worst), outside, back_in);
  return breaches + tilted == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Drives seeded missions with fences, or with hills and pits.", "bench-limits"};
  Arguments arguments;
  app.add_option("--missions", arguments.missions, "how many")->check(CLI::Range(1, 1000000));
  app.add_option("--seed", arguments.seed,
                 "seed of the first mission; the others count up from it");
  app.add_flag("--slopes", arguments.slopes, "hills and pits instead of fences");
  app.add_flag("--verbose", arguments.verbose, "a line for each mission");
  app.add_option("--seconds", arguments.options.seconds, "time limit of each mission")
      ->check(CLI::Range(8.0, 600.0));
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  return runProgram("bench-limits", [&] { return drive(arguments); });
}
