// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/observations.hpp"

namespace tread::gap {

/// Prediction less measurement at the end of one execution, in the frame of its beginning.
struct ExecutionError {
  size_t drive = 0;
  Execution execution;
  int block = 0;
  double position = 0.0;  ///< [m], scaled to the horizon
  double yaw = 0.0;       ///< [rad], scaled to the horizon, not wrapped
  Pose2 predicted{};      ///< where it ends, not scaled
  double way = 0.0;       ///< [m] that it really led away, scaled to the horizon
  double scale = 1.0;     ///< the horizon over the time between the fixes
};

/// The horizon over which errors are told [s].
inline constexpr double kHorizon = 2.0;

/// Errors of a model on all executions that have fixes near their beginning and end.
/** The simulation runs open loop through the whole segment, so that an execution begins in the
 * state that the commands before it led to. Lengths between .75 and 1.25 of the horizon count. */
std::vector<ExecutionError> endErrors(const Observations& data, const ModelDocument& model);
/// The same of motions that were simulated otherwise; one for each segment, as
/// Observations::simulate().
std::vector<ExecutionError> endErrors(const Observations& data, const Motions& motions,
                                      const MeasurementModel& ins);

/// Error of one execution, given the motion predicted between two times of its segment; drive and
/// block are left open.
/** Nothing where there are no fixes near its ends, or no prediction. */
std::optional<ExecutionError> errorOf(
    const Segment& segment, const Execution& execution,
    const std::function<std::optional<Pose2>(double from, double to)>& predict);

/// Median and root mean square.
EndErrors summaryOf(const std::vector<ExecutionError>& errors);

/// Median of the ways of executions [m]; 0 of none.
double medianWay(const std::vector<ExecutionError>& errors);

/// Bootstrap over blocks, in pairs: what is hard to predict is so for both models. Deterministic.
MedianChance chanceOfMedians(const std::vector<ExecutionError>& one,
                             const std::vector<ExecutionError>& other);

/// How far apart two models predict the ends of the same executions, scaled to the horizon; the
/// measurement plays no part.
EndErrors apart(const Observations& data, const ModelDocument& one, const ModelDocument& other);

/// Executions as measured and as two models predict them.
class OverlayMaker {
 public:
  /// Simulates all drives of the rows once with either model; the rows must outlive it.
  OverlayMaker(const Observations& data, const ModelDocument& before, const ModelDocument& after);

  Overlay of(const ExecutionError& error) const;
  /// Where the vehicle was halfway [m], in the frame of the log.
  Eigen::Vector2d middleOf(const ExecutionError& error) const;

 private:
  const Observations& data_;
  MeasurementModel before_;
  MeasurementModel after_;
  /// Of each segment.
  Motions old_motions_;
  Motions new_motions_;
  std::vector<std::vector<MotionSample>> measured_;
};

/// A model and executions that it was not fitted to.
struct Unseen {
  const Observations* data = nullptr;
  ModelDocument model;
  std::vector<ExecutionError> errors;  ///< of the model on these executions
  size_t first_drive = 0;              ///< number of the rows' first drive among all logs
};

/// Typical and worst unseen executions with a band that holds nine of ten, and where all errors
/// are.
/** The band is the residual noise of the fitted model carried along the predicted path (scales of
 * the channels added up over time, the heading's also as a lever), times the factor with which it
 * holds 90 % of the unseen executions at each time. No band where there are fewer than 20. */
ShownExecutions shownExecutions(const std::vector<Unseen>& unseen, const ModelDocument& before,
                                const Noise& noise);

/// The scales with which encoders and gyro explain the poses of a drive best.
struct Reckoning {
  double speed = 1.0;        ///< ground speed over the mean of the encoders' track speeds
  double speed_lag = 0.0;    ///< [s] of the poses behind the encoders
  double turning = 1.0;      ///< of the heading over the gyro
  double turning_lag = 0.0;  ///< [s] of the heading behind the gyro
  double drift = 0.0;        ///< [rad/s] of the heading where the gyro says 0
  double sideways = 0.0;     ///< [s] motion to the left for each v omega
};

/// Fitted over a drive (least absolute deviations); nothing without encoders, gyro or motion.
std::optional<Reckoning> fitReckoning(const Drive& drive);

/// The floor: how far dead reckoning with encoders and gyro ends from the measured poses.
/** Forward speed from the mean of the encoders, yaw rate from the gyro, motion to the side with
 * their product (without it a wide turn at speed ends further off than a good model of the
 * commands); scales and lags fitted to each drive; over the same fixes and scaled to the same
 * horizon as endErrors(). It has seen the motion, so that a model which knows only the commands is
 * not expected to be better (but on ice, where tracks slip). Nothing where no execution has
 * encoders, gyro and poses. */
std::optional<EndErrors> deadReckoningFloor(const std::vector<Drive>& drives);

}  // namespace tread::gap
