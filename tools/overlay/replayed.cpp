// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/overlay/replayed.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/vehicle/measurement.hpp"

namespace tread::overlay {
namespace {

constexpr double kLeadIn = 3.0;      // [s]
constexpr double kFine = 0.02;       // [s], longest step between two poses of a model
constexpr double kLongestGap = 0.3;  // [s] of the INS
constexpr double kLeastPath = 0.3;   // [m] in a piece that counts
constexpr double kLeastTurn = 0.3;   // [rad]

/// The last entry that is not after a time; the first one before all.
template <typename Entry>
size_t indexAt(const std::vector<Entry>& entries, double time) {
  const auto after = std::upper_bound(entries.begin(), entries.end(), time,
                                      [](double t, const Entry& entry) { return t < entry.time; });
  return after == entries.begin() ? 0 : static_cast<size_t>(after - entries.begin()) - 1;
}

Pose2 measuredAtTime(const LoggedDrive& drive, double time) {
  const size_t i = std::min(indexAt(drive.track, time), drive.track.size() - 2);
  const MeasuredPose& from = drive.track[i];
  const MeasuredPose& to = drive.track[i + 1];
  const double share = (time - from.time) / (to.time - from.time);
  const Pose2 &a = from.T_map_body, &b = to.T_map_body;
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.yaw + share * (b.yaw - a.yaw)};
}

bool isCovered(const LoggedDrive& drive, double begin, double end) {
  if (drive.track.front().time > begin || drive.track.back().time < end) return false;
  for (size_t i = indexAt(drive.track, begin); drive.track[i].time < end; ++i)
    if (drive.track[i + 1].time - drive.track[i].time > kLongestGap) return false;
  return true;
}

bool moves(const std::vector<Pose2>& poses) {
  double path = 0.0, turn = 0.0;
  for (size_t i = 1; i < poses.size(); ++i) {
    path += std::hypot(poses[i].x - poses[i - 1].x, poses[i].y - poses[i - 1].y);
    turn += std::abs(poses[i].yaw - poses[i - 1].yaw);
  }
  return path > kLeastPath || turn > kLeastTurn;
}

/// A model's motion under the drive's commands, from rest.
std::vector<MotionSample> driven(const LoggedDrive& drive, const VehicleModel& model, double begin,
                                 double end) {
  VehicleKernel kernel(model, EntryState{});
  std::vector<MotionSample> motion{{begin, {}, 0.0}};
  size_t command = indexAt(drive.commands, begin);
  for (double time = begin; time < end;) {
    double next = std::min(time + kFine, end);
    if (command + 1 < drive.commands.size())
      next = std::min(next, drive.commands[command + 1].time);
    const MeasuredPose& there = drive.track[indexAt(drive.track, time)];
    const GivenCommand& given = drive.commands[command];
    if (next > time) {
      kernel.step(given.command, next - time, {time, given.battery_drop, there.roll, there.pitch});
      motion.push_back({next, kernel.pose(), kernel.twist().omega});
    }
    time = next;
    while (command + 1 < drive.commands.size() && drive.commands[command + 1].time <= time)
      ++command;
  }
  return motion;
}

std::vector<Pose2> predicted(const LoggedDrive& drive, const ModelDocument& model, double begin,
                             size_t samples) {
  const double end = begin + kSample * static_cast<double>(samples);
  const std::vector<MotionSample> motion = driven(drive, model.vehicle, begin - kLeadIn, end);
  const Pose2 T_start_begin = measuredAt(motion, model.measurement, begin).T_map_body;
  std::vector<Pose2> poses;
  for (size_t i = 0; i < samples; ++i) {
    const double time = begin + kSample * static_cast<double>(i);
    poses.push_back(between(T_start_begin, measuredAt(motion, model.measurement, time).T_map_body));
  }
  return poses;
}

std::vector<Pose2> measuredFrom(const LoggedDrive& drive, double begin, size_t samples) {
  const Pose2 T_map_begin = measuredAtTime(drive, begin);
  std::vector<Pose2> poses;
  for (size_t i = 0; i < samples; ++i)
    poses.push_back(
        between(T_map_begin, measuredAtTime(drive, begin + kSample * static_cast<double>(i))));
  return poses;
}

double medianOf(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

double Piece::positionError(size_t model, size_t sample) const {
  const Pose2 &a = measured[sample], &b = predicted[model][sample];
  return std::hypot(b.x - a.x, b.y - a.y);
}

double Piece::yawError(size_t model, size_t sample) const {
  return std::abs(predicted[model][sample].yaw - measured[sample].yaw);
}

std::vector<Piece> replay(const LoggedDrive& drive, const std::vector<ModelDocument>& models,
                          double length) {
  for (const ModelDocument& model : models)
    if (model.vehicle.kind != drive.kind)
      throw std::runtime_error("model " + model.vehicle.name +
                               " takes another kind of command than the log has (power, or track "
                               "speed); give a model of the same vehicle");
  const auto samples = static_cast<size_t>(std::round(length / kSample)) + 1;
  std::vector<Piece> pieces;
  for (double begin = kLeadIn; begin + length < drive.commands.back().time; begin += length) {
    if (!isCovered(drive, begin - kLeadIn, begin + length)) continue;
    Piece piece;
    piece.begin = begin;
    piece.measured = measuredFrom(drive, begin, samples);
    if (!moves(piece.measured)) continue;
    for (const ModelDocument& model : models)
      piece.predicted.push_back(predicted(drive, model, begin, samples));
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

Errors medianErrors(const std::vector<Piece>& pieces, size_t model, size_t sample) {
  std::vector<double> position, yaw;
  for (const Piece& piece : pieces) {
    position.push_back(piece.positionError(model, sample));
    yaw.push_back(piece.yawError(model, sample));
  }
  return {medianOf(std::move(position)), medianOf(std::move(yaw))};
}

}  // namespace tread::overlay
