// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/overlay/drive_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "common/drive/drive_log.hpp"
#include "common/messages/ins_messages.hpp"
#include "common/messages/pattern_messages.hpp"
#include "common/report/plot.hpp"
#include "common/report/text.hpp"
#include "common/vehicle/kernel.hpp"

namespace tread::overlay {
namespace {

double secondsBetween(int64_t from, int64_t to) {
  return 1e-6 * static_cast<double>(to - from);
}

std::vector<GivenCommand> commandsOf(const DriveLog& log) {
  std::vector<GivenCommand> commands;
  double full_voltage = 0.0;
  for (const motor_t& motor : log.motor) {
    const auto voltage = static_cast<double>(motor.battery_voltage);
    if (full_voltage == 0.0 && std::isfinite(voltage)) full_voltage = voltage;
    GivenCommand given;
    given.time = secondsBetween(log.motor.front().utime, motor.utime);
    given.command = {static_cast<double>(motor.command[0]), static_cast<double>(motor.command[1])};
    if (full_voltage > 0.0 && std::isfinite(voltage))
      given.battery_drop = 1.0 - voltage / full_voltage;
    commands.push_back(given);
  }
  return commands;
}

/// The poses since the first MOTOR message.
std::vector<MeasuredPose> trackOf(const DriveLog& log) {
  std::vector<MeasuredPose> track;
  if (log.motor.empty()) return track;
  const int64_t begin = log.motor.front().utime;
  for (const ins_t& ins : log.ins) {
    const std::optional<Pose2> T_map_body = planarPose(ins);
    if (!T_map_body || ins.utime < begin) continue;
    MeasuredPose measured;
    measured.time = secondsBetween(begin, ins.utime);
    measured.T_map_body = *T_map_body;
    if (!track.empty()) {
      const double last = track.back().T_map_body.yaw;
      measured.T_map_body.yaw = last + wrapAngle(T_map_body->yaw - last);
    }
    if (const auto T = spatialPose(ins)) {
      const YawPitchRoll angles = yawPitchRoll(Eigen::Quaterniond(T->linear()));
      measured.roll = angles.roll;
      measured.pitch = angles.pitch;
    }
    track.push_back(measured);
  }
  return track;
}

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

using report::Box;
using report::Panel;
using report::Picture;
using report::Style;

constexpr double kDegrees = 180.0 / kPi;
constexpr size_t kColumns = 3;
constexpr size_t kRows = 2;
constexpr double kSide = 280.0;  // [pixels] of a piece's panel

using Points = std::vector<Eigen::Vector2d>;

Points pointsOf(const std::vector<Pose2>& poses) {
  Points points;
  for (const Pose2& pose : poses) points.push_back(pose.position());
  return points;
}

Style styleOf(const std::vector<std::string>& names, size_t model) {
  // The last model is the one to judge; the others are red and dashed.
  const bool last = model + 1 == names.size();
  return {last ? report::kBlue : report::kRed, last ? 2.0 : 1.8, !last, names[model]};
}

const Style kMeasured{report::kBlack, 4.0, false, "measured"};

void drawPiece(Picture& page, Box box, const Piece& piece, const std::vector<std::string>& names) {
  Points all = pointsOf(piece.measured);
  for (const auto& poses : piece.predicted)
    for (const Pose2& pose : poses) all.push_back(pose.position());
  Panel::Axes axes;
  axes.title = formatted("%.0f s after the beginning", piece.begin);
  axes.x_label = "ahead [m]";
  axes.equal = true;
  axes.x_min = axes.x_max = axes.y_min = axes.y_max = 0.0;
  for (const Eigen::Vector2d& point : all) {
    axes.x_min = std::min(axes.x_min, point.x() - 0.2);
    axes.x_max = std::max(axes.x_max, point.x() + 0.2);
    axes.y_min = std::min(axes.y_min, point.y() - 0.2);
    axes.y_max = std::max(axes.y_max, point.y() + 0.2);
  }
  Panel panel(page, box, axes);
  Style measured = kMeasured;
  measured.label.clear();
  panel.line(pointsOf(piece.measured), measured);
  for (size_t m = 0; m < names.size(); ++m) {
    Style style = styleOf(names, m);
    style.label.clear();
    panel.line(pointsOf(piece.predicted[m]), style);
    panel.dot(piece.predicted[m].back().position(), style.colour, 4.0);
  }
  panel.dot(piece.measured.back().position(), report::kBlack, 5.0);
  panel.finish();
}

/// Median error over the horizon; `yaw` chooses which.
void drawErrors(Picture& page, Box box, const std::vector<Piece>& pieces,
                const std::vector<std::string>& names, bool yaw) {
  const size_t samples = pieces.front().measured.size();
  std::vector<Points> curves(names.size());
  double highest = 0.0;
  for (size_t m = 0; m < names.size(); ++m)
    for (size_t i = 0; i < samples; ++i) {
      const Errors errors = medianErrors(pieces, m, i);
      const double value = yaw ? errors.yaw * kDegrees : errors.position;
      curves[m].emplace_back(kSample * static_cast<double>(i), value);
      highest = std::max(highest, value);
    }
  Panel::Axes axes;
  axes.title = yaw ? "median heading error" : "median position error";
  axes.x_label = "s after the last measured pose";
  axes.y_label = yaw ? "deg" : "m";
  axes.x_max = kSample * static_cast<double>(samples - 1);
  axes.y_max = highest > 0.0 ? 1.35 * highest : 1.0;
  Panel panel(page, box, axes);
  if (!yaw) panel.legendEntry(kMeasured);
  for (size_t m = 0; m < names.size(); ++m) panel.line(curves[m], styleOf(names, m));
  panel.finish();
}

}  // namespace

LoggedDrive readLoggedDrive(const std::vector<std::string>& logs) {
  const DriveLog log = readDriveLog(logs);
  LoggedDrive drive{{}, commandsOf(log), trackOf(log), log.problem};
  for (const auto& [channel, empty] :
       {std::pair{"MOTOR", drive.commands.empty()}, std::pair{"INS", drive.track.empty()}})
    if (empty)
      throw std::runtime_error(logs.front() + ": holds no " + channel +
                               "; a log of a drive has MOTOR and INS");
  for (const motor_t& motor : log.motor)
    if (motor.channel_kind[0] != 0) drive.kinds = kindsFrom(motor);
  if (drive.kinds.empty()) throw std::runtime_error(logs.front() + ": nothing was driven in it");
  return drive;
}

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
    if (kindsOf(model.vehicle.channels()) != drive.kinds)
      throw std::runtime_error(
          "model " + model.vehicle.name +
          " takes another kind of command than the log has (power, track speed "
          "or steering); give a model of the same vehicle");
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

void drawOverlay(const std::string& path, const std::string& title,
                 const std::vector<Piece>& pieces, const std::vector<std::string>& model_names) {
  constexpr size_t kShown = kColumns * kRows;
  const double left = kColumns * (kSide + 50.0);
  Picture page(static_cast<int>(left + 400.0), static_cast<int>(kRows * (kSide + 70.0) + 60.0),
               title);
  for (size_t k = 0; k < std::min(kShown, pieces.size()); ++k) {
    const size_t chosen = pieces.size() <= kShown ? k : (2 * k + 1) * pieces.size() / (2 * kShown);
    const size_t row = k / kColumns, column = k % kColumns;
    const Box box{50.0 + static_cast<double>(column) * (kSide + 50.0),
                  70.0 + static_cast<double>(row) * (kSide + 70.0), kSide, kSide};
    drawPiece(page, box, pieces[chosen], model_names);
  }
  drawErrors(page, {left + 60.0, 70.0, 310.0, kSide}, pieces, model_names, false);
  drawErrors(page, {left + 60.0, 140.0 + kSide, 310.0, kSide}, pieces, model_names, true);
  page.save(path);
}

}  // namespace tread::overlay
