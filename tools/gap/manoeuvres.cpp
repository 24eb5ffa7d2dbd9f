// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/manoeuvres.hpp"

#include <algorithm>
#include <cmath>

#include "common/vehicle/kernel.hpp"

namespace tread::gap {
namespace {

/// Lead before a manoeuvre, and motion behind it: late or early readings need what was there.
constexpr double kLead = 3.0;  // [s]
constexpr double kTail = 1.0;  // [s]

std::vector<TrackCommand> held(const TrackCommand& command, double seconds) {
  return {static_cast<size_t>(std::lround(seconds / kManoeuvrePeriod)), command};
}

std::vector<TrackCommand> followed(std::vector<TrackCommand> first,
                                   const std::vector<TrackCommand>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

EntryState entryOf(const ModelDocument& model, const Manoeuvre& manoeuvre,
                   const Circumstances& circumstances) {
  DriveContext context;
  context.session_time = std::max(0.0, circumstances.session_time - kLead);
  context.battery_drop = circumstances.battery_drop;
  context.roll = circumstances.roll;
  context.pitch = circumstances.pitch;
  EntryState entry = steadyEntry(model.vehicle, manoeuvre.before, context);
  const double share =
      1.0 - std::exp(-circumstances.session_time / model.vehicle.effects.thermal_time);
  entry.heat = {share * circumstances.worked, share * circumstances.worked};
  return entry;
}

void drive(VehicleKernel& kernel, const TrackCommand& command, double& time,
           std::vector<MotionSample>& motion) {
  kernel.step(command, kManoeuvrePeriod);
  time += kManoeuvrePeriod;
  motion.push_back({time, kernel.pose(), kernel.twist().omega});
}

}  // namespace

double fullCommand(const ModelDocument& model) {
  if (model.vehicle.kind == CommandKind::kPower) return 1.0;
  constexpr double kBeyond = 1.25;
  return model.envelope && model.envelope->v > 0.0 ? kBeyond * model.envelope->v : 1.0;
}

std::vector<Manoeuvre> standardManoeuvres(double full) {
  const TrackCommand rest{0.0, 0.0};
  const TrackCommand ahead{full, full};
  const TrackCommand half{0.5 * full, 0.5 * full};
  const TrackCommand back{-0.5 * full, -0.5 * full};
  const auto turn = [&](double left, double right) {
    return TrackCommand{left * full, right * full};
  };
  return {
      {"start to full speed", rest, held(ahead, 2.0)},
      {"straight, full speed", ahead, held(ahead, 2.0)},
      {"straight, half speed", half, held(half, 2.0)},
      {"straight back, half speed", back, held(back, 2.0)},
      {"stop from full speed", ahead, held(rest, 2.0)},
      {"gentle left at full speed", ahead, held(turn(0.8, 1.0), 2.0)},
      {"tight left at full speed", ahead, held(turn(0.3, 1.0), 2.0)},
      {"tight right at full speed", ahead, held(turn(1.0, 0.3), 2.0)},
      {"left at half speed", half, held(turn(0.2, 0.5), 2.0)},
      {"left backwards", back, held(turn(-0.5, -0.2), 2.0)},
      {"slow turn on the spot", rest, held(turn(-0.2, 0.2), 2.0)},
      {"fast turn on the spot", rest, held(turn(-0.7, 0.7), 2.0)},
      {"left, then right", ahead, followed(held(turn(0.5, 1.0), 1.0), held(turn(1.0, 0.5), 1.0))},
      {"forwards, then back", half, followed(held(half, 0.5), held(back, 1.5))},
      {"standing", rest, held(rest, 2.0)},
  };
}

std::vector<MotionSample> drivenByModel(const ModelDocument& model, const Manoeuvre& manoeuvre,
                                        const Circumstances& circumstances,
                                        const ExecutionNoise& noise) {
  VehicleKernel kernel(model.vehicle, entryOf(model, manoeuvre, circumstances));
  double time = std::max(0.0, circumstances.session_time - kLead);
  std::vector<MotionSample> motion{{time, kernel.pose(), kernel.twist().omega}};
  const auto lead = static_cast<size_t>(std::lround(kLead / kManoeuvrePeriod));
  for (size_t i = 0; i < lead; ++i) drive(kernel, manoeuvre.before, time, motion);
  kernel.setNoise(noise);
  for (const TrackCommand& command : manoeuvre.commands) drive(kernel, command, time, motion);
  const auto tail = static_cast<size_t>(std::lround(kTail / kManoeuvrePeriod));
  for (size_t i = 0; i < tail; ++i) drive(kernel, manoeuvre.commands.back(), time, motion);
  const std::vector<MotionSample> said = measure(motion, model.measurement);
  std::vector<MotionSample> driven;
  for (size_t i = lead; i <= lead + manoeuvre.commands.size(); ++i)
    driven.push_back({static_cast<double>(i - lead) * kManoeuvrePeriod,
                      between(said[lead].T_map_body, said[i].T_map_body), said[i].omega});
  return driven;
}

}  // namespace tread::gap
