// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "tools/lab/missions/mission_runner.hpp"

#include <chrono>
#include <ctime>
#include <iostream>
#include <map>
#include <mutex>

#include "common/bus/virtual_bus.hpp"
#include "common/parallel/parallel_for.hpp"
#include "common/report/text.hpp"
#include "modules/simulator/simulator_files.hpp"
#include "tools/lab/missions/referee.hpp"
#include "tools/lab/missions/robot_system.hpp"

namespace tread::missions {
namespace {

/// Share of a timed run's tolerance that the planner gets, so that it aims well inside: 0.6 m of 1
/// m.
constexpr double kAskedShare = 0.6;
constexpr int64_t kTick = 50'000;  ///< [us] between checks of the robot

double threadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Adds the shadow rules' prediction errors.
void addShadows(report::ShadowLearners& shadows, MissionResult& result) {
  shadows.finish();
  result.shadow_rules = shadows.rules();
  std::map<ExecutionKey, std::vector<report::PredictionError>> errors;
  for (report::ShadowedExecution& execution : shadows.executions())
    errors[execution.key] = std::move(execution.by_rule);
  for (ScoredExecution& execution : result.executions) execution.by_rule = errors[execution.key];
}

std::string titleOf(const MissionResult& result) {
  return formatted(
      "Mission %llu: %s after %.0f s and %.1f m (straight line %.1f m), %d patterns, %d "
      "collisions%s%s",
      static_cast<unsigned long long>(result.seed), nameOf(result.outcome), result.time,
      result.distance, result.straight_line, result.completed, result.collisions(),
      result.reason.empty() ? "" : ": ", result.reason.c_str());
}

/// Threads that share the missions of one order.
class BatchRun {
 public:
  BatchRun(const RobotConfig& robot, const BatchOrder& order) : robot_(robot), order_(order) {}

  MissionBatch run() {
    batch_.seed = order_.seed;
    batch_.rule = order_.name;
    batch_.overrides = order_.overrides;
    batch_.results.resize(static_cast<size_t>(order_.missions));
    const auto started = std::chrono::steady_clock::now();
    onThreads(order_.threads)(batch_.results.size(), [this](size_t i) { driveOne(i); });
    batch_.wall_time =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    return std::move(batch_);
  }

 private:
  void driveOne(size_t i) {
    MissionRun run = drive(i);
    const std::lock_guard<std::mutex> lock(mutex_);
    batch_.virtual_time += run.virtual_time;
    batch_.cpu_time += run.cpu_time;
    std::cout << lineOf(run.result) << '\n' << crossingsOf(run.result) << std::flush;
    batch_.results[i] = std::move(run.result);
  }

  MissionRun drive(size_t i) {
    MissionOptions options = order_.options;
    if (!order_.places.empty()) options.place = order_.places.at(i);
    const uint64_t seed = options.place ? options.place->seed : order_.seed + i;
    std::optional<LogWriter> log;
    std::optional<sim::TruthRecord> truth;
    if (!order_.log.empty() && i == 0) options.log = &log.emplace(order_.log);
    if (!order_.truth.empty() && i == 0) options.truth = &truth.emplace(order_.truth);
    MissionRun run = runMission(robot_, seed, options);
    if (log) log->close();
    if (truth) truth->flush();
    if (order_.show == seed) {
      const std::lock_guard<std::mutex> lock(mutex_);
      batch_.shown = driveSceneOf(run.result, run.scene);
      batch_.shown->name = order_.name;
    }
    return run;
  }

  const RobotConfig& robot_;
  const BatchOrder& order_;
  MissionBatch batch_;
  std::mutex mutex_;
};

}  // namespace

MissionRun runMission(const RobotConfig& robot, uint64_t seed, const MissionOptions& options) {
  const double cpu_start = threadSeconds();
  MissionRun run;
  run.scene.world = options.place ? *options.place
                                  : makeMissionWorld(seed, robot.simulated.vehicle.outline,
                                                     options.shortest_line, robot.world);
  RobotSystem system(robot, run.scene.world.description, run.scene.world.T_map_start, seed,
                     options.rule, options.faults, options.known,
                     {vehicleOf(robot.world, robot.simulated.vehicle), nullptr});
  report::ShadowLearners shadows(system.learnerConfig(), options.shadows, system.bus().now());
  if (options.log != nullptr || !options.shadows.empty())
    system.bus().setTap([&](int64_t utime, const char* channel, const uint8_t* bytes, size_t size) {
      if (options.log != nullptr) options.log->write(utime, channel, bytes, size);
      if (shadows.hears(channel)) shadows.hear({utime, channel, {bytes, bytes + size}});
    });
  const MissionWorld& world = run.scene.world;
  Operator person(system.bus().outside(), world.T_map_goal,
                  world.timed ? kAskedShare * world.timed->tolerance : kGoalTolerance);
  Referee referee(system, world);
  const int64_t start = system.bus().now();
  for (int64_t tick = 1; !referee.ended(); ++tick) {
    system.bus().runUntil(start + tick * kTick);
    if (options.truth != nullptr)
      options.truth->note(system.robot().truth(), system.devices().power(system.bus().now()));
    person.step(system.bus().now());
    referee.step();
  }
  run.result = referee.result();
  addShadows(shadows, run.result);
  run.result.seed = seed;
  run.result.rearmed = person.rearmed();
  referee.fillScene(run.scene);
  run.scene.outline = robot.simulated.vehicle.outline;
  run.virtual_time = static_cast<double>(system.bus().now() - start) * 1e-6;
  run.cpu_time = threadSeconds() - cpu_start;
  return run;
}

report::DriveScene driveSceneOf(const MissionResult& result, const MissionScene& scene) {
  report::DriveScene drive;
  drive.title = titleOf(result);
  drive.world = scene.world.description;
  drive.outline = scene.outline;
  drive.map = scene.map;
  drive.tree = scene.tree;
  drive.track = result.track;
  drive.T_map_start = scene.world.T_map_start;
  drive.T_map_goal = scene.world.T_map_goal;
  for (const Contact& contact : result.contacts)
    drive.contacts.push_back(contact.T_map_body.position());
  for (const Stop& stop : result.stops)
    for (const PoseSample& point : result.track) {
      if (point.time < stop.time) continue;
      drive.stops.push_back(point.T_map_body.position());
      break;
    }
  for (const ScoredExecution& execution : result.executions)
    if (execution.measured)
      drive.errors.push_back({execution.time, execution.error_position, execution.error_yaw});
  drive.crossings = result.crossings;
  drive.duration = result.time;
  return drive;
}

MissionBatch runBatch(const RobotConfig& robot, const BatchOrder& order) {
  return BatchRun(robot, order).run();
}

}  // namespace tread::missions
