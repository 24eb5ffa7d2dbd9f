// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/end_errors.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "common/soundness/core/lag_table.hpp"
#include "common/statistics/statistics.hpp"

namespace tread::gap {

namespace {

constexpr double kNearest =
    0.25;  // [s] largest distance of a fix from an execution's beginning or end
constexpr int kOverlayPoints = 21;

const InsSample* nearestFix(const Segment& segment, double time) {
  const InsSample* nearest = nullptr;
  const auto after =
      std::lower_bound(segment.ins.begin(), segment.ins.end(), time - kNearest,
                       [](const InsSample& sample, double from) { return sample.time < from; });
  for (auto sample = after; sample != segment.ins.end() && sample->time <= time + kNearest;
       ++sample) {
    if (!sample->hasPose()) continue;
    if (nearest == nullptr || std::abs(sample->time - time) < std::abs(nearest->time - time))
      nearest = &*sample;
  }
  return nearest;
}

Pose2 predictedBetween(const std::vector<MotionSample>& motion, const MeasurementModel& ins,
                       double from, double to) {
  return between(measuredAt(motion, ins, from).T_map_body, measuredAt(motion, ins, to).T_map_body);
}

ErrorFigure figureOf(std::vector<double> errors) {
  ErrorFigure figure;
  if (errors.empty()) return figure;
  figure.rms = rmsOf(errors);
  figure.median = medianOf(std::move(errors));
  return figure;
}

constexpr int kMedianDraws = 200;

/// Errors by block: position and yaw.
struct BlockErrors {
  std::vector<double> position;
  std::vector<double> yaw;
};

std::map<int, BlockErrors> byBlock(const std::vector<ExecutionError>& errors) {
  std::map<int, BlockErrors> blocks;
  for (const ExecutionError& error : errors) {
    blocks[error.block].position.push_back(error.position);
    blocks[error.block].yaw.push_back(error.yaw);
  }
  return blocks;
}

/// Median over some blocks, which may be repeated.
double medianOver(const std::map<int, BlockErrors>& blocks, const std::vector<int>& drawn,
                  std::vector<double> BlockErrors::*of) {
  std::vector<double> errors;
  for (const int block : drawn) {
    const auto found = blocks.find(block);
    if (found == blocks.end()) continue;
    const std::vector<double>& more = found->second.*of;
    errors.insert(errors.end(), more.begin(), more.end());
  }
  return figureOf(std::move(errors)).median;
}

double deviationOf(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  const double mean = meanOf(values);
  double square = 0.0;
  for (const double value : values) square += (value - mean) * (value - mean);
  return std::sqrt(square / (count - 1.0));
}

constexpr size_t kTypical = 6;
constexpr size_t kWorst = 3;
constexpr size_t kLeastForBand = 20;
constexpr double kShare = 0.9;  // of the executions inside the band

/// An execution with the position uncertainty along its path, up to a factor.
struct Shown {
  Overlay overlay;
  std::vector<double> spread;  ///< [m] at each point
  double error = 0.0;          ///< [m] at the end, scaled to the horizon
};

double scaleOf(const ChannelNoise& noise, double activity) {
  return std::hypot(noise.still, noise.share * activity);
}

std::vector<double> spreadOf(const Overlay& overlay, const Noise& noise) {
  const double dt = overlay.duration / static_cast<double>(overlay.after.size() - 1);
  const auto of = [&noise](ObservedRate channel) { return noise[static_cast<size_t>(channel)]; };
  double heading = 0.0;
  double along = 0.0;
  double across = 0.0;
  std::vector<double> spread{0.0};
  for (size_t i = 1; i < overlay.after.size(); ++i) {
    const Pose2 moved = between(overlay.after[i - 1], overlay.after[i]);
    const double way = moved.position().norm();
    along += dt * scaleOf(of(ObservedRate::kAlong), way / dt);
    across += dt * scaleOf(of(ObservedRate::kAcross), way / dt) + heading * way;
    heading += dt * scaleOf(of(ObservedRate::kHeading), std::abs(moved.yaw) / dt);
    spread.push_back(std::hypot(along, across));
  }
  return spread;
}

std::vector<Shown> shownOf(const std::vector<Unseen>& unseen, const ModelDocument& before,
                           const Noise& noise, std::vector<PlaceError>& places) {
  std::vector<Shown> all;
  for (const Unseen& part : unseen) {
    const OverlayMaker maker(*part.data, before, part.model);
    for (const ExecutionError& error : part.errors) {
      Shown shown;
      shown.overlay = maker.of(error);
      shown.overlay.drive += part.first_drive;
      shown.spread = spreadOf(shown.overlay, noise);
      shown.error = error.position;
      const Eigen::Vector2d place = maker.middleOf(error);
      places.push_back({shown.overlay.drive, place.x(), place.y(), shown.overlay.error_before,
                        shown.overlay.error_after});
      all.push_back(std::move(shown));
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Shown& a, const Shown& b) { return a.error < b.error; });
  return all;
}

/// Factor by which spreads contain the required share of all executions, at each point.
std::vector<double> factorsOf(const std::vector<Shown>& all) {
  std::vector<double> factors;
  for (size_t point = 0; point < all.front().spread.size(); ++point) {
    std::vector<double> ratios;
    for (const Shown& shown : all) {
      const double apart =
          (shown.overlay.measured[point].position() - shown.overlay.after[point].position()).norm();
      ratios.push_back(shown.spread[point] > 0.0 ? apart / shown.spread[point] : 0.0);
    }
    factors.push_back(lowerQuantile(std::move(ratios), kShare));
  }
  return factors;
}

}  // namespace

std::optional<ExecutionError> errorOf(
    const Segment& segment, const Execution& execution,
    const std::function<std::optional<Pose2>(double from, double to)>& predict) {
  const InsSample* from = nearestFix(segment, execution.begin);
  const InsSample* to = nearestFix(segment, execution.end);
  if (from == nullptr || to == nullptr) return std::nullopt;
  const double length = to->time - from->time;
  if (length < 0.75 * kHorizon || length > 1.25 * kHorizon) return std::nullopt;
  const auto predicted = predict(from->time, to->time);
  if (!predicted) return std::nullopt;
  const Pose2 measured = between(from->T_map_body, to->T_map_body);
  const double scale = kHorizon / length;
  ExecutionError error;
  error.execution = execution;
  error.position = scale * (predicted->position() - measured.position()).norm();
  error.yaw = scale * std::abs(predicted->yaw - measured.yaw);
  error.predicted = *predicted;
  error.way = scale * measured.position().norm();
  error.scale = scale;
  return error;
}

std::vector<ExecutionError> endErrors(const Observations& data, const ModelDocument& model) {
  return endErrors(data, data.simulate(model.vehicle), model.measurement);
}

std::vector<ExecutionError> endErrors(const Observations& data, const Motions& motions,
                                      const MeasurementModel& ins) {
  std::vector<ExecutionError> errors;
  for (size_t drive = 0; drive < data.drives().size(); ++drive)
    for (const Execution& execution : data.drives()[drive].executions) {
      const size_t segment = execution.segment;
      const auto& motion = motions[data.segmentIndex(drive, segment)];
      int block = 0;
      auto error = errorOf(data.drives()[drive].segments[segment], execution,
                           [&](double from, double to) -> std::optional<Pose2> {
                             block = data.blockAt(drive, segment, (from + to) / 2.0);
                             return predictedBetween(motion, ins, from, to);
                           });
      if (!error) continue;
      error->drive = drive;
      error->block = block;
      errors.push_back(*error);
    }
  return errors;
}

EndErrors summaryOf(const std::vector<ExecutionError>& errors) {
  std::vector<double> position;
  std::vector<double> yaw;
  for (const ExecutionError& error : errors) {
    position.push_back(error.position);
    yaw.push_back(error.yaw);
  }
  return {figureOf(std::move(position)), figureOf(std::move(yaw)), errors.size()};
}

double medianWay(const std::vector<ExecutionError>& errors) {
  std::vector<double> ways;
  for (const ExecutionError& error : errors) ways.push_back(error.way);
  return medianOf(std::move(ways), 0.0);
}

MedianChance chanceOfMedians(const std::vector<ExecutionError>& one,
                             const std::vector<ExecutionError>& other) {
  const std::map<int, BlockErrors> ones = byBlock(one);
  const std::map<int, BlockErrors> others = byBlock(other);
  if (ones.size() < 2) return {};
  std::vector<int> blocks;
  for (const auto& [block, errors] : ones) blocks.push_back(block);
  std::mt19937_64 random(1);
  std::vector<double> position;
  std::vector<double> yaw;
  std::vector<int> drawn(blocks.size());
  for (int draw = 0; draw < kMedianDraws; ++draw) {
    for (int& block : drawn) block = blocks[random() % blocks.size()];
    position.push_back(medianOver(others, drawn, &BlockErrors::position) -
                       medianOver(ones, drawn, &BlockErrors::position));
    yaw.push_back(medianOver(others, drawn, &BlockErrors::yaw) -
                  medianOver(ones, drawn, &BlockErrors::yaw));
  }
  return {deviationOf(position), deviationOf(yaw)};
}

EndErrors apart(const Observations& data, const ModelDocument& one, const ModelDocument& other) {
  std::vector<ExecutionError> errors = endErrors(data, one);
  const std::vector<ExecutionError> others = endErrors(data, other);
  errors.resize(std::min(errors.size(), others.size()));
  for (size_t i = 0; i < errors.size(); ++i) {
    errors[i].position =
        errors[i].scale * (errors[i].predicted.position() - others[i].predicted.position()).norm();
    errors[i].yaw = errors[i].scale * std::abs(errors[i].predicted.yaw - others[i].predicted.yaw);
  }
  return summaryOf(errors);
}

OverlayMaker::OverlayMaker(const Observations& data, const ModelDocument& before,
                           const ModelDocument& after)
    : data_(data), before_(before.measurement), after_(after.measurement) {
  old_motions_ = data.simulate(before.vehicle);
  new_motions_ = data.simulate(after.vehicle);
  for (const Drive& drive : data.drives())
    for (const Segment& segment : drive.segments) {
      measured_.emplace_back();
      for (const InsSample& sample : segment.ins)
        if (sample.hasPose()) measured_.back().push_back({sample.time, sample.T_map_body});
    }
}

Overlay OverlayMaker::of(const ExecutionError& error) const {
  const size_t index = data_.segmentIndex(error.drive, error.execution.segment);
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

Eigen::Vector2d OverlayMaker::middleOf(const ExecutionError& error) const {
  const size_t index = data_.segmentIndex(error.drive, error.execution.segment);
  return poseAt(measured_[index], 0.5 * (error.execution.begin + error.execution.end)).position();
}

ShownExecutions shownExecutions(const std::vector<Unseen>& unseen, const ModelDocument& before,
                                const Noise& noise) {
  ShownExecutions result;
  std::vector<Shown> all = shownOf(unseen, before, noise, result.places);
  if (all.empty()) return result;
  if (all.size() >= kLeastForBand) {
    const std::vector<double> factors = factorsOf(all);
    for (Shown& shown : all)
      for (size_t point = 0; point < factors.size(); ++point)
        shown.overlay.band.push_back(factors[point] * shown.spread[point]);
  }
  const size_t typical = std::min(kTypical, all.size());
  for (size_t i = 0; i < typical; ++i)
    result.overlays.push_back(all[all.size() * (i + 1) / (kTypical + 2)].overlay);
  for (size_t i = 0; i < std::min(kWorst, all.size()); ++i)
    result.overlays.push_back(all[all.size() - 1 - i].overlay);
  return result;
}

namespace {

constexpr double kStep = 0.05;    // [s] of integration
constexpr double kCertain = 0.5;  // |correlation| required for a scale

/// Mean of the encoders' track speeds, by segment.
RunningSums meanSpeeds(const Drive& drive) {
  return encoderSums(drive, [](const TrackCommand& c) { return 0.5 * (c.left + c.right); });
}

/// A pair of rates; the first explains the second.
struct Rates {
  double leading;
  double following;
};

/// Factor of the leading rate with the least absolute deviations from `following - offset`.
double scaleOf(std::vector<Rates> rates, double offset) {
  double weight = 0.0;
  for (Rates& r : rates) {
    weight += std::abs(r.leading);
    r.following = r.leading == 0.0 ? 0.0 : (r.following - offset) / r.leading;
  }
  std::sort(rates.begin(), rates.end(),
            [](const Rates& a, const Rates& b) { return a.following < b.following; });
  double sum = 0.0;
  for (const Rates& r : rates)
    if ((sum += std::abs(r.leading)) >= 0.5 * weight) return r.following;
  return 1.0;
}

double offsetOf(const std::vector<Rates>& rates, double scale) {
  std::vector<double> rest;
  for (const Rates& r : rates) rest.push_back(r.following - scale * r.leading);
  return quantileOf(std::move(rest), 0.5);
}

/// Lateral motion per v omega, from poses alone [s].
double sidewaysOf(const std::vector<PoseIncrement>& increments) {
  std::vector<Rates> rates;
  for (const PoseIncrement& increment : increments) {
    const double v = increment.v();
    // In the body frame of the middle of the turn.
    const double across =
        increment.T_begin_end.y / increment.duration() - 0.5 * increment.T_begin_end.yaw * v;
    if (std::abs(increment.T_begin_end.yaw) < 1.0) rates.push_back({v * increment.omega(), across});
  }
  return rates.empty() ? 0.0 : scaleOf(rates, 0.0);
}

std::vector<Rates> pairs(const std::vector<PoseIncrement>& increments,
                         const std::vector<double>& following, const RunningSums& sums,
                         double lag) {
  std::vector<Rates> all;
  for (size_t i = 0; i < increments.size(); ++i) {
    const auto leading =
        sums[increments[i].segment].mean(increments[i].begin - lag, increments[i].end - lag);
    if (leading) all.push_back({*leading, following[i]});
  }
  return all;
}

/// A drive with all data for its dead reckoning.
class Reckoner {
 public:
  Reckoner(const Drive& drive, const Reckoning& fit)
      : drive_(drive), fit_(fit), speed_(meanSpeeds(drive)), gyro_(gyroSums(drive)) {}

  std::optional<ExecutionError> errorOfReckoning(const Execution& execution) const {
    return errorOf(drive_.segments[execution.segment], execution,
                   [&](double from, double to) { return motion(execution.segment, from, to); });
  }

 private:
  std::optional<Pose2> motion(size_t segment, double from, double to) const {
    const auto steps = static_cast<int>(std::ceil((to - from) / kStep));
    const double dt = (to - from) / steps;
    Pose2 T_from_body;
    for (int i = 0; i < steps; ++i) {
      const double begin = from + dt * i;
      const auto speed = speed_[segment].mean(begin - fit_.speed_lag, begin + dt - fit_.speed_lag);
      const auto omega =
          gyro_[segment].mean(begin - fit_.turning_lag, begin + dt - fit_.turning_lag);
      if (!speed || !omega) return std::nullopt;
      const double v = fit_.speed * *speed;
      const double turn = fit_.turning * *omega + fit_.drift;
      T_from_body = T_from_body * integrate({v, fit_.sideways * v * turn, turn}, dt);
    }
    return T_from_body;
  }

  const Drive& drive_;
  const Reckoning fit_;
  const RunningSums speed_;
  const RunningSums gyro_;
};

}  // namespace

std::optional<Reckoning> fitReckoning(const Drive& drive) {
  if (drive.encoders.empty() || drive.layout == VehicleLayout::kOmni) return std::nullopt;
  const auto increments = poseIncrements(drive);
  const std::vector<double> v = ratesOf(increments, &PoseIncrement::v);
  const std::vector<double> omega = ratesOf(increments, &PoseIncrement::omega);
  const RunningSums encoders = meanSpeeds(drive);
  const RunningSums gyro = gyroSums(drive);
  const auto lags = lagGrid(-0.5, 1.0, 0.02);
  const auto forward = LagTable(increments, v, encoders, lags).best(0, increments.size());
  const auto turn = LagTable(increments, omega, gyro, lags).best(0, increments.size());
  if (!forward || !turn || forward->correlation < kCertain || turn->correlation < kCertain)
    return std::nullopt;
  Reckoning fit;
  fit.speed_lag = forward->lag;
  fit.turning_lag = turn->lag;
  fit.speed = scaleOf(pairs(increments, v, encoders, fit.speed_lag), 0.0);
  const auto turns = pairs(increments, omega, gyro, fit.turning_lag);
  for (int i = 0; i < 3; ++i) {
    fit.turning = scaleOf(turns, fit.drift);
    fit.drift = offsetOf(turns, fit.turning);
  }
  fit.sideways = sidewaysOf(increments);
  return fit;
}

std::optional<EndErrors> deadReckoningFloor(const std::vector<Drive>& drives) {
  std::vector<ExecutionError> errors;
  for (const Drive& drive : drives) {
    const auto fit = fitReckoning(drive);
    if (!fit) continue;
    const Reckoner reckoner(drive, *fit);
    for (const Execution& execution : drive.executions)
      if (const auto error = reckoner.errorOfReckoning(execution)) errors.push_back(*error);
  }
  if (errors.empty()) return std::nullopt;
  return summaryOf(errors);
}

}  // namespace tread::gap
