// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/overlay/drive_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/drive/drive_log.hpp"
#include "common/report/plot.hpp"
#include "common/report/text.hpp"
#include "common/soundness/drive_log.hpp"
#include "common/statistics/statistics.hpp"
#include "common/vehicle/kernel.hpp"
#include "modules/identification/core/observations.hpp"

namespace tread::overlay {
namespace {

constexpr double kLeadIn = 3.0;      // [s]
constexpr double kFine = 0.02;       // [s], longest step between two poses of a model
constexpr double kLongestGap = 0.3;  // [s] of the INS
constexpr double kLeastPath = 0.3;   // [m] in a piece that counts
constexpr double kLeastTurn = 0.3;   // [rad]

bool isDriven(const gap::Segment& segment) {
  return std::any_of(segment.commands.begin(), segment.commands.end(),
                     [](const CommandSample& sample) { return sample.command != TrackCommand{}; });
}

/// The poses measured by the INS.
std::vector<MotionSample> measuredIn(const gap::Segment& segment) {
  std::vector<MotionSample> motion;
  for (const gap::InsSample& sample : segment.ins)
    if (sample.hasPose()) motion.push_back({sample.time, sample.T_map_body, 0.0});
  return motion;
}

bool isCovered(const std::vector<MotionSample>& motion, double begin, double end) {
  double last = motion.empty() || motion.front().time > begin ? -1e9 : begin;
  for (const MotionSample& sample : motion) {
    if (last > end) return true;
    if (sample.time > begin && sample.time - last > kLongestGap) return false;
    last = std::max(last, sample.time);
  }
  return last >= end;
}

bool moves(const std::vector<Pose2>& poses) {
  double path = 0.0, turn = 0.0;
  for (size_t i = 1; i < poses.size(); ++i) {
    path += distanceBetween(poses[i - 1], poses[i]);
    turn += std::abs(poses[i].yaw - poses[i - 1].yaw);
  }
  return path > kLeastPath || turn > kLeastTurn;
}

/// The poses of a piece relative to the first one, as measured by an INS with these properties.
std::vector<Pose2> posesOf(const std::vector<MotionSample>& motion, const MeasurementModel& ins,
                           double begin, size_t samples) {
  const auto at = [&](size_t sample) {
    return measuredAt(motion, ins, begin + kSample * static_cast<double>(sample)).T_map_body;
  };
  std::vector<Pose2> poses;
  for (size_t i = 0; i < samples; ++i) poses.push_back(between(at(0), at(i)));
  return poses;
}

void addPieces(const gap::Drive& drive, const gap::Segment& segment,
               const std::vector<ModelDocument>& models, double length,
               std::vector<ComparedPiece>& pieces) {
  const auto samples = static_cast<size_t>(std::round(length / kSample)) + 1;
  const std::vector<MotionSample> measured = measuredIn(segment);
  const gap::SegmentPlan plan(drive, segment, kFine);
  std::vector<std::vector<MotionSample>> motions;
  for (const ModelDocument& model : models) motions.push_back(plan.simulate(model.vehicle));
  for (double begin = segment.begin() + kLeadIn; begin + length < segment.end; begin += length) {
    if (!isCovered(measured, begin - kLeadIn, begin + length)) continue;
    ComparedPiece piece{begin, posesOf(measured, {}, begin, samples), {}};
    if (!moves(piece.measured)) continue;
    for (size_t m = 0; m < models.size(); ++m)
      piece.predicted.push_back(posesOf(motions[m], models[m].measurement, begin, samples));
    pieces.push_back(std::move(piece));
  }
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
  // The last model is the evaluated one; the others are red and dashed.
  const bool last = model + 1 == names.size();
  return {last ? report::kBlue : report::kRed, last ? 2.0 : 1.8, !last, names[model]};
}

const Style kMeasured{report::kBlack, 4.0, false, "measured"};

void drawPiece(Picture& page, Box box, const ComparedPiece& piece,
               const std::vector<std::string>& names) {
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

/// Median error over the horizon; `yaw` selects heading instead of position.
void drawErrors(Picture& page, Box box, const std::vector<ComparedPiece>& pieces,
                const std::vector<std::string>& names, bool yaw) {
  const size_t samples = pieces.front().measured.size();
  std::vector<Points> curves(names.size());
  double highest = 0.0;
  for (size_t m = 0; m < names.size(); ++m)
    for (size_t i = 0; i < samples; ++i) {
      const MedianErrors errors = medianErrors(pieces, m, i);
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

gap::Drive readLoggedDrive(const std::vector<std::string>& logs, std::string& problem) {
  const DriveLog log = readDriveLog(logs);
  problem = log.problem;
  for (const auto& [channel, empty] :
       {std::pair{"MOTOR", log.motor.empty()}, std::pair{"INS", log.ins.empty()}})
    if (empty)
      throw std::runtime_error(logs.front() + ": holds no " + channel +
                               "; a log of a drive has MOTOR and INS");
  gap::Drive drive = gap::toDrive(log);
  if (std::none_of(drive.segments.begin(), drive.segments.end(), isDriven))
    throw std::runtime_error(logs.front() + ": nothing was driven in it");
  return drive;
}

double ComparedPiece::positionError(size_t model, size_t sample) const {
  const Pose2 &a = measured[sample], &b = predicted[model][sample];
  return std::hypot(b.x - a.x, b.y - a.y);
}

double ComparedPiece::yawError(size_t model, size_t sample) const {
  return std::abs(predicted[model][sample].yaw - measured[sample].yaw);
}

std::vector<ComparedPiece> replay(const gap::Drive& drive, const std::vector<ModelDocument>& models,
                                  double length) {
  for (const ModelDocument& model : models)
    if (model.vehicle.kind != drive.kind || model.vehicle.layout() != drive.layout)
      throw std::runtime_error("model " + model.vehicle.name +
                               " needs another kind of command than the log has (power, track "
                               "speed, a car's or a holonomic base's); give a model of "
                               "the same vehicle");
  std::vector<ComparedPiece> pieces;
  for (const gap::Segment& segment : drive.segments)
    addPieces(drive, segment, models, length, pieces);
  return pieces;
}

MedianErrors medianErrors(const std::vector<ComparedPiece>& pieces, size_t model, size_t sample) {
  std::vector<double> position, yaw;
  for (const ComparedPiece& piece : pieces) {
    position.push_back(piece.positionError(model, sample));
    yaw.push_back(piece.yawError(model, sample));
  }
  return {upperMedian(std::move(position)), upperMedian(std::move(yaw))};
}

void drawOverlay(const std::string& path, const std::string& title,
                 const std::vector<ComparedPiece>& pieces,
                 const std::vector<std::string>& model_names) {
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
