// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// A vehicle has a dead band that its model lacks: which effect explains its drive, how large?
#include <cstdio>
#include <random>

#include "modules/identification/core/discovery.hpp"

using namespace tread;
gap::Drive driveOf(const VehicleModel& vehicle) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  VehicleKernel kernel(vehicle, EntryState{});
  gap::Drive drive;
  gap::Segment& segment = drive.segments.emplace_back();
  for (double start = 0.0; start < 600.0; start += 2.0) {
    const TrackCommand command{draw(random), draw(random)};
    segment.commands.push_back({start, command});
    drive.executions.push_back({0, start, start + 2.0});
    for (double now = start; now < start + 1.995; now += 0.01) {
      const Pose2 error{0.05 * draw(random), 0.05 * draw(random), 0.005 * draw(random)};
      segment.ins.push_back(
          {now, kernel.pose() * error, kernel.twist().omega + 0.1 * draw(random)});
      kernel.step(command, 0.01, {});
    }
  }
  segment.end = 600.0;
  return drive;
}

int main() {
  gap::GapTask task;
  task.model.vehicle.lag = 0.2;
  VehicleModel truth = task.model.vehicle;
  truth.effects.motor_deadband = 0.1;
  task.train = {driveOf(truth)};
  const gap::GapFinding found = gap::findGap(task, [](const std::string&) {});
  for (const auto& effect : found.identified.effects)
    std::printf("%s %.3f\n", effect.name.c_str(), effect.parameters.at(0).value);
}
