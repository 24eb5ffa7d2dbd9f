// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/core/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace tread::gap {
namespace {

constexpr double kTransient = 0.8;  // [s] after a change of command; then all changes slowly
constexpr double kSlowly = 2.0;     // pieces are so much longer then

/// Roll and pitch at a moment; where the INS does not say, as they were, level at first.
void levelAt(const std::vector<InsSample>& ins, double time, size_t& next, DriveContext& context) {
  for (; next < ins.size() && ins[next].time <= time; ++next) {
    if (std::isfinite(ins[next].roll)) context.roll = ins[next].roll;
    if (std::isfinite(ins[next].pitch)) context.pitch = ins[next].pitch;
  }
}

/// Relative fall of the battery's voltage since the first sample.
double dropAt(const std::vector<VoltageSample>& voltage, double time, size_t& at) {
  if (voltage.empty() || voltage.front().voltage <= 0.0) return 0.0;
  while (at + 1 < voltage.size() && voltage[at + 1].time <= time) ++at;
  return 1.0 - voltage[at].voltage / voltage.front().voltage;
}

}  // namespace

StretchPlan::StretchPlan(const Drive& drive, const Stretch& stretch, double piece)
    : begin_(stretch.begin()),
      entry_speeds_(stretch.entry_speeds),
      command_before_(stretch.command_before) {
  DriveContext context;
  size_t ins_next = 0;
  size_t voltage_at = 0;
  for (size_t i = 0; i < stretch.commands.size(); ++i) {
    const double from = stretch.commands[i].time;
    const double to = i + 1 < stretch.commands.size() ? stretch.commands[i + 1].time : stretch.end;
    const double settled = to - from > 1.5 * kTransient ? from + kTransient : to;
    for (const auto& [begin, end, longest] :
         {std::tuple{from, settled, piece}, std::tuple{settled, to, kSlowly * piece}}) {
      const int count = static_cast<int>(std::ceil((end - begin) / longest - 1e-6));
      const double duration = (end - begin) / std::max(1, count);
      for (int n = 0; n < count; ++n) {
        context.session_time = begin + n * duration;
        levelAt(stretch.ins, context.session_time + duration / 2.0, ins_next, context);
        context.battery_drop = dropAt(drive.voltage, context.session_time, voltage_at);
        pieces_.push_back({duration, stretch.commands[i].command, context});
        longest_ = std::max(longest_, duration);
      }
    }
  }
}

EntryState StretchPlan::entryFor(const VehicleModel& vehicle) const {
  EntryState entry = steadyEntry(vehicle, command_before_, pieces_.front().context);
  if (entry_speeds_) entry.track_speeds = *entry_speeds_;
  return entry;
}

std::vector<TimedPose> StretchPlan::simulate(const VehicleModel& vehicle) const {
  VehicleModel model = vehicle;
  model.step = longest_;  // lags and ramps are exact within one
  VehicleKernel kernel(model, entryFor(model));
  std::vector<TimedPose> motion;
  motion.reserve(pieces_.size() + 1);
  double time = begin_;
  motion.push_back({time, kernel.pose()});
  for (const Piece& piece : pieces_) {
    kernel.step(piece.command, piece.duration, piece.context);
    time += piece.duration;
    motion.push_back({time, kernel.pose()});
  }
  return motion;
}

}  // namespace tread::gap
