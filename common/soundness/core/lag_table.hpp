// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/soundness/core/log_validation.hpp"

namespace tread::gap {

/// Increments over 0.4 to 1.2 s, one after the other, in order of time.
std::vector<PoseIncrement> poseIncrements(const Drive& drive);

/// One rate of all increments: &PoseIncrement::v or &PoseIncrement::omega.
std::vector<double> ratesOf(const std::vector<PoseIncrement>& increments,
                            double (PoseIncrement::*rate)() const);

/// A running sum over time, within one segment, linear between its points.
class RunningSum {
 public:
  /// Appends a rate that holds from `begin` to `end` [s]; a gap before it starts a new piece.
  void add(double begin, double end, double rate);
  /// Mean rate over an interval; nullopt unless it is known throughout.
  std::optional<double> mean(double begin, double end) const;

 private:
  struct Point {
    double time;
    double sum;
    size_t piece;  ///< unknown between pieces
  };
  std::optional<std::pair<double, size_t>> at(double time) const;
  std::vector<Point> points_;
};

/// Running sums of a drive, by segment.
using RunningSums = std::vector<RunningSum>;
/// Of the gyro [rad].
RunningSums gyroSums(const Drive& drive);
/// Of a rate of the encoders' track speeds, such as their mean.
RunningSums encoderSums(const Drive& drive, const std::function<double(const TrackCommand&)>& rate);
/// Of the motor currents, left or right [A s].
RunningSums currentSums(const Drive& drive, double CurrentSample::*side);
/// Of a rate of the commands.
RunningSums commandSums(const Drive& drive, const std::function<double(const TrackCommand&)>& rate);
/// Of right minus left command, and of their mean.
RunningSums turnCommandSums(const Drive& drive);
RunningSums driveCommandSums(const Drive& drive);

/// Rates of increments against another rate at many lags; uses increments for which it is known at
/// all lags.
class LagTable {
 public:
  /// `rates` of the increments; `sums` of the leading rate, which is evaluated `lag` earlier.
  LagTable(const std::vector<PoseIncrement>& increments, const std::vector<double>& rates,
           const RunningSums& sums, std::vector<double> lags);

  /// The match at one of the lags over increments [first, last); nullopt if fewer than a third of
  /// the increments are usable, or there is no motion.
  std::optional<LagMatch> match(size_t lag, size_t first, size_t last) const;
  /// The match with the largest correlation (sign 1) or the most negative one (sign -1) among lags
  /// from `from` to `to` [s], refined between the lags.
  std::optional<LagMatch> best(size_t first, size_t last, double sign = 1.0, double from = -1e9,
                               double to = 1e9) const;
  /// The match at the lag nearest to a time.
  std::optional<LagMatch> near(double lag, size_t first, size_t last) const;
  size_t increments() const { return rates_.size(); }

 private:
  std::vector<double> rates_;
  std::vector<double> lags_;
  std::vector<std::vector<double>> leading_;  ///< by lag, by increment; NaN = not known
};

/// Times from `begin` to `end` with equal steps [s].
std::vector<double> lagGrid(double begin, double end, double step);

}  // namespace tread::gap
