// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <random>

#include "common/vehicle/kernel.hpp"
#include "tools/experiment/seeds.hpp"
#include "tools/experiment/transition_world.hpp"

namespace tread::experiment {
namespace {

using recordings::Execution;

/// The commands of a pattern, each held `length` times as long.
std::vector<TrackCommand> stretched(const std::vector<TrackCommand>& commands, int length) {
  std::vector<TrackCommand> longer;
  for (const TrackCommand& command : commands)
    longer.insert(longer.end(), static_cast<size_t>(length), command);
  return longer;
}

/// The patterns as a set; what it predicts is the first surface's mean motion.
PatternSet setOf(const TransitionWorld& world, int length) {
  const VehicleModel& model = world.surfaces.front().model;
  PatternSetContent content;
  content.name = world.name;
  content.period_us = std::llround(world.period * 1e6);
  content.classes = {{"entry", steadyTwist(model, world.entry), world.entry}};
  for (const WorldPattern& executed : world.patterns) {
    MotionPattern pattern;
    pattern.id = static_cast<int>(content.patterns.size()) + 1;
    pattern.name = executed.name;
    pattern.entry_class = pattern.exit_class = "entry";
    pattern.commands = stretched(executed.commands, length);
    pattern.trajectory =
        simulate(model, pattern.commands, world.period, steadyEntry(model, world.entry));
    content.patterns.push_back(std::move(pattern));
  }
  std::string why;
  std::optional<PatternSet> set = PatternSet::make(std::move(content), why);
  if (!set) throw recordings::RecordingError(world.name + ": " + why);
  return *set;
}

Execution execute(const TransitionWorld& world, const VehicleModel& model,
                  const std::vector<TrackCommand>& commands, std::mt19937_64& random) {
  const ExecutionNoise noise = drawNoise(model.spread, random);
  Execution measured =
      simulate(model, commands, world.period, steadyEntry(model, world.entry), noise);
  std::normal_distribution<double> standard;
  for (Pose2& pose : measured) {
    pose.x += world.position_noise * standard(random);
    pose.y += world.position_noise * standard(random);
    pose.yaw += world.yaw_noise * standard(random);
  }
  return measured;
}

}  // namespace

recordings::PatternRecordings record(const TransitionWorld& world, uint64_t seed, int length) {
  recordings::PatternRecordings book{setOf(world, length), {}};
  for (size_t s = 0; s < world.surfaces.size(); ++s) {
    recordings::SurfaceRecordings surface{world.surfaces[s].name, {}};
    for (size_t p = 0; p < world.patterns.size(); ++p) {
      std::mt19937_64 random(seedOf({seed, s, p}));
      std::vector<Execution> executions;
      for (int64_t i = 0; i < world.recordings; ++i)
        executions.push_back(
            execute(world, world.surfaces[s].model, book.patterns.patterns()[p].commands, random));
      surface.executions.push_back(std::move(executions));
    }
    book.surfaces.push_back(std::move(surface));
  }
  return book;
}

}  // namespace tread::experiment
