// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/end_errors.hpp"

#include <algorithm>
#include <cmath>

#include "modules/identification/core/log_validation.hpp"

namespace tread::gap {
namespace {

constexpr double kStep = 0.05;       // [s] of integration
constexpr double kEncoderGap = 0.5;  // [s] over which encoders are held
constexpr double kCertain = 0.5;     // |correlation| that a scale needs

/// Mean of the encoders' track speeds, by segment.
RunningSums encoderSums(const Drive& drive) {
  RunningSums sums;
  for (const Segment& segment : drive.segments) {
    RunningSum sum;
    auto sample = std::lower_bound(
        drive.encoders.begin(), drive.encoders.end(), segment.begin() - kEncoderGap,
        [](const EncoderSample& encoder, double time) { return encoder.time < time; });
    for (; sample != drive.encoders.end() && sample->time < segment.end; ++sample) {
      const auto next = std::next(sample);
      const bool held = next != drive.encoders.end() && next->time - sample->time <= kEncoderGap;
      if (held) sum.add(sample->time, next->time, 0.5 * (sample->speed.left + sample->speed.right));
    }
    sums.push_back(std::move(sum));
  }
  return sums;
}

/// A pair of rates, the second one to be explained by the first.
struct Rates {
  double leading;
  double following;
};

/// Factor of the leading rate with the least sum of absolute deviations from `following - offset`.
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
  return quantile(std::move(rest));
}

/// Motion to the side for each v omega, from poses alone [s].
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

/// One drive with all that its reckoning needs.
class Reckoner {
 public:
  Reckoner(const Drive& drive, const Reckoning& fit)
      : drive_(drive), fit_(fit), speed_(encoderSums(drive)), gyro_(gyroSums(drive)) {}

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
  if (drive.encoders.empty()) return std::nullopt;
  const auto increments = poseIncrements(drive);
  const std::vector<double> v = ratesOf(increments, &PoseIncrement::v);
  const std::vector<double> omega = ratesOf(increments, &PoseIncrement::omega);
  const RunningSums encoders = encoderSums(drive);
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
