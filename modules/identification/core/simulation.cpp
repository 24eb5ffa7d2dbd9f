// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace tread::gap {
namespace {

constexpr double kTransient = 0.8;  // [s] after a change of command; then all changes slowly
constexpr double kSlowly = 2.0;     // pieces are so much longer then
constexpr double kShortest = 1e-3;  // [s] cuts closer than that are one

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

std::vector<double> StretchPlan::endsBetween(double from, double to, double longest,
                                             const std::vector<double>& cuts) {
  std::vector<double> fixed;
  for (auto cut = std::upper_bound(cuts.begin(), cuts.end(), from + kShortest);
       cut != cuts.end() && *cut < to - kShortest; ++cut)
    if (fixed.empty() || *cut > fixed.back() + kShortest) fixed.push_back(*cut);
  fixed.push_back(to);
  std::vector<double> ends;
  for (double end : fixed) {
    const int count = std::max(1, static_cast<int>(std::ceil((end - from) / longest - 1e-6)));
    for (int n = 1; n < count; ++n) ends.push_back(from + n * (end - from) / count);
    ends.push_back(end);
    from = end;
  }
  return ends;
}

StretchPlan::StretchPlan(const Drive& drive, const Stretch& stretch, double piece,
                         const std::vector<double>& cuts)
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
      double time = begin;
      for (double next : endsBetween(begin, end, longest, cuts)) {
        const double duration = next - time;
        if (duration <= 0.0) continue;
        context.session_time = time;
        levelAt(stretch.ins, time + duration / 2.0, ins_next, context);
        context.battery_drop = dropAt(drive.voltage, time, voltage_at);
        pieces_.push_back({duration, stretch.commands[i].command, context});
        longest_ = std::max(longest_, duration);
        time = next;
      }
    }
  }
}

EntryState StretchPlan::entryFor(const VehicleModel& vehicle) const {
  EntryState entry = steadyEntry(vehicle, command_before_, pieces_.front().context);
  if (entry_speeds_) entry.track_speeds = *entry_speeds_;
  return entry;
}

std::vector<MotionSample> StretchPlan::simulate(const VehicleModel& vehicle) const {
  VehicleModel model = vehicle;
  model.step = longest_;  // lags and ramps are exact within one
  VehicleKernel kernel(model, entryFor(model));
  std::vector<MotionSample> motion;
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
