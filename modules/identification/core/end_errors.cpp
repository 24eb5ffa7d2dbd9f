// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/end_errors.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tread::gap {
namespace {

constexpr double kNearest = 0.25;  // [s] a fix may be away from an execution's beginning or end
constexpr int kOverlayPoints = 21;

using Motions = std::vector<std::vector<MotionSample>>;

const InsSample* nearestFix(const Stretch& stretch, double time) {
  const InsSample* nearest = nullptr;
  const auto after =
      std::lower_bound(stretch.ins.begin(), stretch.ins.end(), time - kNearest,
                       [](const InsSample& sample, double moment) { return sample.time < moment; });
  for (auto sample = after; sample != stretch.ins.end() && sample->time <= time + kNearest;
       ++sample) {
    if (!std::isfinite(sample->T_map_body.x)) continue;
    if (nearest == nullptr || std::abs(sample->time - time) < std::abs(nearest->time - time))
      nearest = &*sample;
  }
  return nearest;
}

Pose2 predictedBetween(const std::vector<MotionSample>& motion, const MeasurementModel& ins,
                       double from, double to) {
  return between(measuredAt(motion, ins, from).T_map_body, measuredAt(motion, ins, to).T_map_body);
}

std::optional<EndError> errorOf(const Rows& rows, size_t drive, const Execution& execution,
                                const Motions& motions, const MeasurementModel& ins) {
  const Stretch& stretch = rows.drives()[drive].stretches[execution.stretch];
  const InsSample* from = nearestFix(stretch, execution.begin);
  const InsSample* to = nearestFix(stretch, execution.end);
  if (from == nullptr || to == nullptr) return std::nullopt;
  const double length = to->time - from->time;
  if (length < 0.75 * kHorizon || length > 1.25 * kHorizon) return std::nullopt;
  const auto& motion = motions[rows.stretchIndex(drive, execution.stretch)];
  const Pose2 predicted = predictedBetween(motion, ins, from->time, to->time);
  const Pose2 measured = between(from->T_map_body, to->T_map_body);
  const double scale = kHorizon / length;
  EndError error;
  error.drive = drive;
  error.execution = execution;
  error.block = rows.blockAt(drive, execution.stretch, (from->time + to->time) / 2.0);
  error.position = scale * (predicted.position() - measured.position()).norm();
  error.yaw = scale * std::abs(predicted.yaw - measured.yaw);
  return error;
}

ErrorFigure figureOf(std::vector<double> errors) {
  ErrorFigure figure;
  if (errors.empty()) return figure;
  for (double error : errors) figure.rms += error * error;
  figure.rms = std::sqrt(figure.rms / static_cast<double>(errors.size()));
  std::sort(errors.begin(), errors.end());
  const size_t middle = errors.size() / 2;
  figure.median =
      errors.size() % 2 == 1 ? errors[middle] : (errors[middle - 1] + errors[middle]) / 2.0;
  return figure;
}

}  // namespace

std::vector<EndError> endErrors(const Rows& rows, const ModelDocument& model) {
  return endErrors(rows, rows.simulate(model.vehicle), model.measurement);
}

std::vector<EndError> endErrors(const Rows& rows, const Motions& motions,
                                const MeasurementModel& measurement) {
  std::vector<EndError> errors;
  for (size_t drive = 0; drive < rows.drives().size(); ++drive)
    for (const Execution& execution : rows.drives()[drive].executions)
      if (const auto error = errorOf(rows, drive, execution, motions, measurement))
        errors.push_back(*error);
  return errors;
}

EndErrors summaryOf(const std::vector<EndError>& errors,
                    const std::function<bool(const EndError&)>& counts) {
  std::vector<double> position;
  std::vector<double> yaw;
  for (const EndError& error : errors) {
    if (!counts(error)) continue;
    position.push_back(error.position);
    yaw.push_back(error.yaw);
  }
  EndErrors summary;
  summary.executions = position.size();
  summary.position = figureOf(std::move(position));
  summary.yaw = figureOf(std::move(yaw));
  return summary;
}

OverlayMaker::OverlayMaker(const Rows& rows, const ModelDocument& before,
                           const ModelDocument& after)
    : rows_(rows), before_(before.measurement), after_(after.measurement) {
  old_motions_ = rows.simulate(before.vehicle);
  new_motions_ = rows.simulate(after.vehicle);
  for (const Drive& drive : rows.drives())
    for (const Stretch& stretch : drive.stretches) {
      measured_.emplace_back();
      for (const InsSample& sample : stretch.ins)
        if (std::isfinite(sample.T_map_body.x))
          measured_.back().push_back({sample.time, sample.T_map_body});
    }
}

Overlay OverlayMaker::of(const EndError& error) const {
  const size_t index = rows_.stretchIndex(error.drive, error.execution.stretch);
  const double begin = error.execution.begin;
  Overlay overlay;
  overlay.drive = error.drive;
  overlay.begin = begin;
  overlay.duration = error.execution.end - begin;
  const Pose2 T_map_begin = poseAt(measured_[index], begin);
  for (int i = 0; i < kOverlayPoints; ++i) {
    const double time = begin + overlay.duration * i / (kOverlayPoints - 1.0);
    overlay.measured.push_back(between(T_map_begin, poseAt(measured_[index], time)));
    overlay.before.push_back(predictedBetween(old_motions_[index], before_, begin, time));
    overlay.after.push_back(predictedBetween(new_motions_[index], after_, begin, time));
  }
  const Eigen::Vector2d end = overlay.measured.back().position();
  overlay.error_before = (overlay.before.back().position() - end).norm();
  overlay.error_after = (overlay.after.back().position() - end).norm();
  return overlay;
}

Eigen::Vector2d OverlayMaker::middleOf(const EndError& error) const {
  const size_t index = rows_.stretchIndex(error.drive, error.execution.stretch);
  return poseAt(measured_[index], 0.5 * (error.execution.begin + error.execution.end)).position();
}

}  // namespace tread::gap
