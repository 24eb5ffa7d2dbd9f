// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/patterns/model_recording.hpp"

#include <random>
#include <stdexcept>
#include <vector>

#include "common/vehicle/kernel.hpp"

namespace tread::patterns {
namespace {

const char* kindName(CommandKind kind) {
  return kind == CommandKind::kPower ? "power" : "track speed";
}

recordings::Execution execute(const VehicleModel& model, const MotionPattern& pattern,
                              double period, const EntryState& entry, const ModelRecording& how,
                              std::mt19937_64& random) {
  const ExecutionNoise noise = drawNoise(model.spread, random);
  recordings::Execution measured = simulate(model, pattern.commands, period, entry, noise);
  std::normal_distribution<double> standard;
  for (Pose2& pose : measured) {
    pose.x += how.position * standard(random);
    pose.y += how.position * standard(random);
    pose.yaw += how.yaw * standard(random);
  }
  return measured;
}

/// A series of its own for each surface and pattern.
std::mt19937_64 randomFor(uint64_t seed, const std::string& surface, int pattern_id) {
  std::vector<uint32_t> words{static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32U),
                              static_cast<uint32_t>(pattern_id)};
  for (const char letter : surface) words.push_back(static_cast<unsigned char>(letter));
  std::seed_seq seeds(words.begin(), words.end());
  return std::mt19937_64(seeds);
}

}  // namespace

recordings::SurfaceRecordings recordModel(const PatternSet& set, const VehicleModel& model,
                                          const std::string& surface, const ModelRecording& how) {
  if (model.kind != set.content().kind)
    throw std::runtime_error(std::string("the patterns command ") + kindName(set.content().kind) +
                             ", the model takes " + kindName(model.kind) +
                             "; give a model of the same vehicle");
  recordings::SurfaceRecordings recorded{surface, {}};
  for (const MotionPattern& pattern : set.patterns()) {
    std::mt19937_64 random = randomFor(how.seed, surface, pattern.id);
    const EntryState entry = steadyEntry(model, set.classNamed(pattern.entry_class).steady);
    std::vector<recordings::Execution> executions;
    for (int e = 0; e < how.executions; ++e)
      executions.push_back(execute(model, pattern, set.periodSeconds(), entry, how, random));
    recorded.executions.push_back(std::move(executions));
  }
  return recorded;
}

}  // namespace tread::patterns
