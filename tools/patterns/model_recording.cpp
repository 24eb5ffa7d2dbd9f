// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/patterns/model_recording.hpp"

#include <algorithm>
#include <iostream>
#include <random>
#include <stdexcept>
#include <vector>

#include "common/vehicle/kernel.hpp"
#include "common/vehicle/measurement.hpp"

namespace tread::patterns {
namespace {

constexpr double kLeadIn = 3.0;  // [s], longer than any latency of an INS

const char* kindName(CommandKind kind) {
  return kind == CommandKind::kPower ? "power" : "track speed";
}

/// What a late, askew or biased INS says of an execution, relative to what it said at its start.
recordings::Execution seenByIns(const ModelDocument& model, const MotionPattern& pattern,
                                double period, EntryState entry, const ExecutionNoise& noise) {
  const auto before = static_cast<size_t>(kLeadIn / period) + 1;
  const double begin = -period * static_cast<double>(before);
  entry.context.session_time = begin;
  VehicleKernel kernel(model.vehicle, entry, noise);
  std::vector<MotionSample> motion{{begin, kernel.pose(), kernel.twist().omega}};
  for (size_t i = 0; i < before + pattern.commands.size(); ++i) {
    kernel.step(i < before ? entry.command : pattern.commands[i - before], period);
    const double time = begin + period * static_cast<double>(motion.size());
    motion.push_back({time, kernel.pose(), kernel.twist().omega});
  }
  const std::vector<MotionSample> said = measure(motion, model.measurement);
  recordings::Execution seen;
  for (size_t i = before + 1; i < said.size(); ++i)
    seen.push_back(between(said[before].T_map_body, said[i].T_map_body));
  return seen;
}

recordings::Execution execute(const ModelDocument& model, const MotionPattern& pattern,
                              double period, const EntryState& entry, const ModelRecording& how,
                              std::mt19937_64& random) {
  const ExecutionNoise noise = drawNoise(model.vehicle.spread, random);
  recordings::Execution measured =
      isPerfect(model.measurement) ? simulate(model.vehicle, pattern.commands, period, entry, noise)
                                   : seenByIns(model, pattern, period, entry, noise);
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

void requireSameKind(const PatternSet& set, const VehicleModel& model) {
  if (model.kind != set.content().kind)
    throw std::runtime_error(std::string("the patterns command ") + kindName(set.content().kind) +
                             ", the model takes " + kindName(model.kind) +
                             "; give a model of the same vehicle");
}

recordings::SurfaceRecordings recordModel(const PatternSet& set, const ModelDocument& model,
                                          const std::string& surface, const ModelRecording& how) {
  requireSameKind(set, model.vehicle);
  recordings::SurfaceRecordings recorded{surface, {}};
  for (const MotionPattern& pattern : set.patterns()) {
    std::mt19937_64 random = randomFor(how.seed, surface, pattern.id);
    const EntryState entry = steadyEntry(model.vehicle, set.classNamed(pattern.entry_class).steady);
    std::vector<recordings::Execution> executions;
    for (int e = 0; e < how.executions; ++e)
      executions.push_back(execute(model, pattern, set.periodSeconds(), entry, how, random));
    recorded.executions.push_back(std::move(executions));
  }
  return recorded;
}

Envelope envelopeOf(const VehicleModel& model, const PatternSet& set) {
  Envelope all;
  for (const MotionPattern& pattern : set.patterns()) {
    const EntryState entry = steadyEntry(model, set.classNamed(pattern.entry_class).steady);
    const Envelope one = tread::envelopeOf(model, pattern.commands, set.periodSeconds(), entry);
    all.v = std::max(all.v, one.v);
    all.omega = std::max(all.omega, one.omega);
    all.v_omega = std::max(all.v_omega, one.v_omega);
  }
  return all;
}

void warnOutside(const ModelDocument& document, const std::string& model_file,
                 const PatternSet& set) {
  requireSameKind(set, document.vehicle);
  if (!document.envelope) return;
  for (const std::string& line :
       warningsOutside(*document.envelope, envelopeOf(document.vehicle, set)))
    std::cerr << model_file << ": warning: " << line << '\n';
}

}  // namespace tread::patterns
