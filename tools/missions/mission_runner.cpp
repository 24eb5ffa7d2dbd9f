// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/missions/mission_runner.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>

#include "common/bus/virtual_bus.hpp"
#include "tools/missions/mission_watch.hpp"
#include "tools/missions/operator.hpp"

namespace tread::missions {
namespace {

constexpr int64_t kTick = 50'000;  ///< [us] between looks at the robot

double threadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void tell(const MissionOptions& options, const MissionWatch& watch, int64_t tick) {
  if (options.progress && tick % 20 == 0) options.progress(watch.progress());
}

/// What the rules beside the drive made of its executions.
void addShadows(shadow::ShadowLearners& shadows, MissionResult& result) {
  shadows.finish();
  result.shadow_rules = shadows.rules();
  std::map<shadow::ExecutionKey, std::vector<shadow::EndError>> errors;
  for (shadow::ShadowedExecution& execution : shadows.executions())
    errors[execution.key] = std::move(execution.by_rule);
  for (ScoredExecution& execution : result.executions) execution.by_rule = errors[execution.key];
}

}  // namespace

MissionRun runMission(const RobotConfig& robot, uint64_t seed, const MissionOptions& options) {
  const double cpu_start = threadSeconds();
  MissionRun run;
  run.scene.world = makeMissionWorld(seed, options.shortest_line);
  RobotSystem system(robot, run.scene.world.description, run.scene.world.T_map_start, seed,
                     options.rule, options.faults, options.true_patterns);
  shadow::ShadowLearners shadows(system.learnerConfig(), options.shadows, system.bus().now());
  if (options.log != nullptr || !options.shadows.empty())
    system.bus().setTap([&](int64_t utime, const char* channel, const uint8_t* bytes, size_t size) {
      if (options.log != nullptr) options.log->write(utime, channel, bytes, size);
      if (shadows.hears(channel)) shadows.hear(utime, {utime, channel, {bytes, bytes + size}});
    });
  Operator person(system.bus().outside(), run.scene.world.T_map_goal);
  MissionWatch watch(system, run.scene.world);
  const int64_t start = system.bus().now();
  for (int64_t tick = 1; !watch.ended(); ++tick) {
    system.bus().runUntil(start + tick * kTick);
    person.step(system.bus().now());
    watch.step();
    tell(options, watch, tick);
  }
  run.result = watch.result();
  addShadows(shadows, run.result);
  run.result.seed = seed;
  run.result.rearmed = person.rearmed();
  watch.fillScene(run.scene);
  run.virtual_time = static_cast<double>(system.bus().now() - start) * 1e-6;
  run.cpu_time = threadSeconds() - cpu_start;
  return run;
}

}  // namespace tread::missions
