// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Missions of the whole robot in virtual time with seeded faults; the rules are checked from
// outside.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/config/command_line.hpp"
#include "tests/bench/faults/fault_run.hpp"
#include "tests/bench/faults/lie_table.hpp"
#include "tests/bench/faults/return_run.hpp"

namespace {

using namespace tread;
using namespace tread::faults;

constexpr double kNamedWithin = 0.5;  // [s] of motion

struct Arguments {
  int missions = 100;
  uint64_t seed = 1;
  bool only = false;
  bool go_back = false;
  bool bare = false;
  bool lies = false;
  bool eyes = false;
  bool table = false;
  std::string fault;
  RunOptions run;
};

void printSeed(uint64_t seed, const FaultSchedule& schedule, const FaultyRun& run) {
  std::printf("seed %llu, %s\n", static_cast<unsigned long long>(seed),
              schedule.keyed ? "with a key" : "without a key");
  for (const Fault& fault : schedule.faults) std::printf("  %s\n", describe(fault).c_str());
  const std::string scenario = describe(schedule.scenario);
  if (!scenario.empty()) std::printf("  %s\n", scenario.c_str());
  if (run.collisions > 0) std::printf("  touched something %d times\n", run.collisions);
  if (run.violation)
    std::printf(
        "  BROKEN at utime %lld, %.3f s: %s\n", static_cast<long long>(run.violation->utime),
        static_cast<double>(run.violation->utime - 1'000'000) * 1e-6, run.violation->what.c_str());
  std::fflush(stdout);
}

int drive(const Arguments& arguments) {
  const missions::RobotConfig robot = missions::readRobot(TREAD_CONFIG_DIR "/robots/teodor");
  const RunOptions& options = arguments.run;
  int broken = 0, drove = 0, again = 0, arrived = 0, collided = 0;
  int by_hand = 0, lied = 0, alone = 0, moved = 0, returned = 0, tilts = 0, fences = 0, held = 0;
  double least_room = 1e9;
  int64_t paths = 0, faults = 0;
  const int missions = arguments.only ? 1 : arguments.missions;
  for (int i = 0; i < missions; ++i) {
    const uint64_t seed = arguments.seed + static_cast<uint64_t>(i);
    const FaultSchedule schedule = arguments.bare   ? bareScheduleOf(seed, options.duration)
                                   : arguments.lies ? lyingScheduleOf(seed, options.duration)
                                                    : scheduleOf(seed, options.duration);
    const FaultyRun run = runFaulty(robot, schedule, options);
    if (run.violation || run.collisions > 0 || arguments.only) printSeed(seed, schedule, run);
    broken += run.violation ? 1 : 0;
    drove += run.drove ? 1 : 0;
    again += run.drove_after || run.arrived ? 1 : 0;
    arrived += run.arrived ? 1 : 0;
    collided += run.collisions > 0 ? 1 : 0;
    by_hand += run.by_hand ? 1 : 0;
    lied += run.lied ? 1 : 0;
    alone += run.lied && schedule.onlyLies() ? 1 : 0;
    moved += run.by_hand && schedule.onlyLies() ? 1 : 0;
    returned += run.returned ? 1 : 0;
    tilts += run.tilt_stop ? 1 : 0;
    fences += run.fence_stop ? 1 : 0;
    held += std::isfinite(run.least_room) ? 1 : 0;
    least_room = std::min(least_room, run.least_room);
    paths += run.paths_judged;
    faults += static_cast<int64_t>(schedule.faults.size());
  }
  std::printf(
      "%d missions, %lld faults: %d broke a rule; %d drove, %d drove or had arrived after the last "
      "fault, %d arrived within %.0f s, %d touched something; %lld patterns judged\n",
      missions, static_cast<long long>(faults), broken, drove, again, arrived, options.duration,
      collided, static_cast<long long>(paths));
  std::printf(
      "%d were driven by hand, %d moved without their operator, %d were stopped for their tilt, %d "
      "at a fence; %d held to fences, least room %.3f m\n",
      by_hand, returned, tilts, fences, held, least_room);
  std::printf(
      "%d had a stick that lies, its button held while the robot was armed; in %d nobody else told "
      "of a rest: %d of them were moved by a stick that was not seen at rest\n",
      lied, alone, moved);
  return broken == 0 ? 0 : 1;
}

/// Missions whose operator falls silent for good: does the robot return?
int goBack(const Arguments& arguments) {
  const missions::RobotConfig robot = missions::readRobot(TREAD_CONFIG_DIR "/robots/teodor");
  int lost = 0, at_link = 0, at_start = 0, collided = 0, moving = 0;
  double away = 0.0;
  for (int i = 0; i < arguments.missions; ++i) {
    const uint64_t seed = arguments.seed + static_cast<uint64_t>(i);
    const ReturnRun run = runReturn(robot, seed);
    if (!run.lost) continue;
    ++lost;
    away += run.away;
    at_link += run.missed_link < 1.0 ? 1 : 0;
    at_start += run.returned_after > 0.0 ? 1 : 0;
    collided += run.collisions > 0 ? 1 : 0;
    moving += run.moved_at_end ? 1 : 0;
    const bool good = run.missed_link < 1.0 && run.returned_after > 0.0 && run.collisions == 0;
    if (good && !arguments.only) continue;
    std::printf(
        "seed %llu: lost %.1f m away, came within %.2f m of the last link, ended %.2f m from its "
        "start, %d contacts: %s\n",
        static_cast<unsigned long long>(seed), run.away, run.missed_link, run.missed_start,
        run.collisions, run.state.c_str());
    std::fflush(stdout);
  }
  std::printf(
      "%d returns from %.1f m away on average: %d came within 1 m of the last good link, %d on to "
      "within 1 m of where their way began, %d touched something, %d moved at the end\n",
      lost, lost > 0 ? away / lost : 0.0, at_link, at_start, collided, moving);
  return collided == 0 && moving == 0 ? 0 : 1;
}

/// Results of the missions with one lie of the range finder.
struct EyeFigures {
  int missions = 0, moved = 0, brief = 0, collided = 0;
  double farthest = 0.0;
  std::vector<double> after;  ///< [s] until mapping reported it

  void count(const FaultyRun& run);
  void print(const char* name);
};

/// A lie that ends before it must be reported.
bool isBrief(const FaultEffect& effect) {
  return effect.lasted < kNamedWithin && !effect.named_after;
}

void EyeFigures::count(const FaultyRun& run) {
  ++missions;
  collided += run.collisions > 0 ? 1 : 0;
  if (!run.effect.moved) return;
  ++moved;
  brief += isBrief(run.effect) ? 1 : 0;
  if (!run.effect.named_after) return;
  after.push_back(*run.effect.named_after);
  farthest = std::max(farthest, run.effect.zero_way);
}

void EyeFigures::print(const char* name) {
  std::sort(after.begin(), after.end());
  const auto in_time = std::upper_bound(after.begin(), after.end(), kNamedWithin) - after.begin();
  std::printf(
      "%-26s %3d missions, moved under it in %3d, in %d for less than %.1f s; named in %3zu, in "
      "time %3lld, after %.2f s (median) to %.2f s, stood after %.2f m at most; %d touched "
      "something\n",
      name, missions, moved, brief, kNamedWithin, after.size(), static_cast<long long>(in_time),
      after.empty() ? 0.0 : after[after.size() / 2], after.empty() ? 0.0 : after.back(), farthest,
      collided);
}

/// Missions with a lying range finder: is it reported, and does the robot stop before a contact?
int watchEyes(const Arguments& arguments) {
  const missions::RobotConfig robot = missions::readRobot(TREAD_CONFIG_DIR "/robots/teodor");
  std::map<FaultKind, EyeFigures> by_kind;
  int collided = 0;
  for (int i = 0; i < (arguments.only ? 1 : arguments.missions); ++i) {
    const uint64_t seed = arguments.seed + static_cast<uint64_t>(i);
    const FaultSchedule schedule = scanScheduleOf(seed, arguments.run.duration);
    const FaultKind kind = schedule.faults.front().kind;
    if (!arguments.fault.empty() && arguments.fault != nameOf(kind)) continue;
    const FaultyRun run = runFaulty(robot, schedule, arguments.run);
    const FaultEffect& effect = run.effect;
    by_kind[kind].count(run);
    collided += run.collisions > 0 ? 1 : 0;
    const bool late = effect.moved && effect.named_after.value_or(effect.lasted) > kNamedWithin;
    if (!late && !run.violation && run.collisions == 0 && !arguments.only) continue;
    printSeed(seed, schedule, run);
    std::printf("  named after %.2f s, %.2f m, %.0f deg; zero after %.2f s, %.2f m: %s\n",
                effect.named_after.value_or(-1.0), effect.named_way,
                effect.named_turn * 180.0 / 3.14159265, effect.zero_after.value_or(-1.0),
                effect.zero_way, effect.reason.c_str());
    std::fflush(stdout);
  }
  for (auto& [kind, figures] : by_kind) figures.print(nameOf(kind));
  std::printf("%d touched something\n", collided);
  return collided == 0 ? 0 : 1;
}

/// Effect of each lie of each input.
int printTable(const Arguments& arguments) {
  const missions::RobotConfig robot = missions::readRobot(TREAD_CONFIG_DIR "/robots/teodor");
  std::vector<uint64_t> seeds;
  for (int i = 0; i < arguments.missions; ++i)
    seeds.push_back(arguments.seed + static_cast<uint64_t>(i));
  int collisions = 0;
  for (const Lie& lie : lies()) {
    const LieFigures figures = measure(robot, lie, seeds);
    std::printf(
        "%-17s %-26s stopped %d of %d, zero after %4.0f ms at most, stood after %.2f m, %d "
        "contacts: %s\n",
        lie.input, lie.way, figures.stopped, figures.missions, 1e3 * figures.after, figures.way,
        figures.collisions, figures.reason.c_str());
    std::fflush(stdout);
    collisions += figures.collisions;
  }
  return collisions == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Drives seeded missions with seeded faults and checks the rules from outside.",
               "bench-faults"};
  Arguments arguments;
  app.add_option("--missions", arguments.missions, "how many")->check(CLI::Range(1, 1000000));
  app.add_option("--seed", arguments.seed,
                 "seed of the first mission; the others count up from it");
  app.add_flag("--only", arguments.only, "only this seed, with a list of its faults");
  app.add_flag(
      "--go-back", arguments.go_back,
      "instead of faults: the operator goes silent permanently, and the robot should return");
  app.add_flag("--lies", arguments.lies,
               "each mission with a pad, keyboard or page that never reports rest");
  app.add_flag(
         "--eyes", arguments.eyes,
         "instead of faults: false range finder data from a random moment on; is it detected?")
      ->excludes("--go-back");
  app.add_option("--fault", arguments.fault, "with --eyes: only this fault")->needs("--eyes");
  app.add_flag("--table", arguments.table,
               "instead of faults: number of missions for each fault of each input; prints "
               "stopping times")
      ->excludes("--go-back")
      ->excludes("--eyes");
  app.add_flag("--bare", arguments.bare, "without fences, manual control, tilts and returns");
  app.add_option("--seconds", arguments.run.duration, "of each mission")
      ->check(CLI::Range(8.0, 600.0));
  app.add_option("--beams", arguments.run.beams, "beams of each scan; the range finder has 541")
      ->check(CLI::Range(91, 1081));
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  return runProgram("bench-faults", [&] {
    if (arguments.table) return printTable(arguments);
    if (arguments.eyes) return watchEyes(arguments);
    return arguments.go_back ? goBack(arguments) : drive(arguments);
  });
}
