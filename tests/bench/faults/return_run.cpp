// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/bench/faults/return_run.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "tools/lab/missions/mission.hpp"

namespace tread::faults {
namespace {

constexpr int64_t kReturnTick = 50'000;  // [us]
constexpr double kBack = 1.0;            // [m]
constexpr int64_t kFirstLoss = 12'000'000;
constexpr int64_t kLastLoss = 45'000'000;

}  // namespace

ReturnRun runReturn(missions::RobotConfig robot, uint64_t seed) {
  robot.planner.operators.lost = robot.motor_bridge.bridge.operators.lost = OperatorLost::kGoBack;
  const missions::MissionWorld world =
      missions::makeMissionWorld(seed, robot.simulated.vehicle.outline);
  missions::RobotSystem system(robot, world.description, world.T_map_start, seed, "", {});
  VirtualBus& bus = system.bus();
  missions::Operator person(bus.outside(), world.T_map_goal);
  ReturnRun run;
  bus.outside().subscribe<plan_t>(kPlan, [&](const plan_t& plan) { run.state = plan.reason; });
  std::mt19937_64 random(seed);
  const int64_t silent =
      bus.now() + std::uniform_int_distribution<int64_t>(kFirstLoss, kLastLoss)(random);
  const int64_t end = silent + robot.planner.operators.return_us + 40'000'000;
  const auto place = [&] { return system.robot().truth().T_map_body.position(); };
  const Eigen::Vector2d p_start = world.T_map_start.position();
  Eigen::Vector2d p_link = p_start;
  size_t touched = 0;
  int64_t stood_since = silent;
  while (bus.now() < end && bus.now() - stood_since < 35'000'000) {
    bus.runUntil(bus.now() + kReturnTick);
    const int64_t now = bus.now();
    const sim::MotorValues power = system.devices().power(now);
    run.moved_at_end = power[0] != 0.0 || power[1] != 0.0;
    if (run.moved_at_end || now < silent) stood_since = now;
    if (now <= silent) {
      person.step(now);
      p_link = place();
      touched = system.robot().truth().collisions.size();
      run.lost = run.moved_at_end && (p_link - p_start).norm() > 2.0;
      run.away = run.missed_link = (p_link - p_start).norm();
      continue;
    }
    if (now - silent < robot.planner.operators.lease_us + 2'000'000) continue;  // still stopping
    run.missed_link = std::min(run.missed_link, (place() - p_link).norm());
    if (run.returned_after == 0.0 && (place() - p_start).norm() < kBack)
      run.returned_after = static_cast<double>(now - silent) * 1e-6;
  }
  run.missed_start = (place() - p_start).norm();
  run.collisions = static_cast<int>(system.robot().truth().collisions.size() - touched);
  return run;
}

}  // namespace tread::faults
