// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/likelihood.hpp"

namespace tread::gap {

/// Predicted minus measured pose at the end of one execution, in the frame of its beginning.
struct ExecutionError {
  size_t drive = 0;
  Execution execution;
  int block = 0;
  double position = 0.0;  ///< [m], scaled to the horizon
  double yaw = 0.0;       ///< [rad], scaled to the horizon, not wrapped
  Pose2 predicted{};      ///< end of the prediction, not scaled
  double way = 0.0;       ///< [m] measured distance from beginning to end, scaled to the horizon
  double scale = 1.0;     ///< ratio of the horizon to the time between the fixes
};

/// Horizon of the reported errors [s].
inline constexpr double kHorizon = 2.0;

/// Errors of a model on all executions with fixes near their beginning and end.
/** The simulation runs open loop through the whole segment, so that an execution begins in the
 * state that results from the earlier commands. Executions of .75 to 1.25 horizons count. */
std::vector<ExecutionError> endErrors(const Observations& data, const ModelDocument& model);
/// The same for given motions; one for each segment, as Observations::simulate().
std::vector<ExecutionError> endErrors(const Observations& data, const Motions& motions,
                                      const MeasurementModel& ins);

/// Error of one execution, given the predicted motion between two times of its segment; does not
/// set drive and block.
/** nullopt if there are no fixes near its ends, or no prediction. */
std::optional<ExecutionError> errorOf(
    const Segment& segment, const Execution& execution,
    const std::function<std::optional<Pose2>(double from, double to)>& predict);

/// Median and root mean square.
EndErrors summaryOf(const std::vector<ExecutionError>& errors);

/// Median of the executions' `way` [m]; 0 for no executions.
double medianWay(const std::vector<ExecutionError>& errors);

/// Paired bootstrap over blocks, because hard blocks are hard for both models. Deterministic.
MedianChance chanceOfMedians(const std::vector<ExecutionError>& one,
                             const std::vector<ExecutionError>& other);

/// Difference between two models' predictions of the ends of the same executions, scaled to the
/// horizon; independent of the measurement.
EndErrors apart(const Observations& data, const ModelDocument& one, const ModelDocument& other);

/// Executions as measured and as predicted by two models.
class OverlayMaker {
 public:
  /// Simulates all drives of the rows once with each model; the rows must outlive it.
  OverlayMaker(const Observations& data, const ModelDocument& before, const ModelDocument& after);

  Overlay of(const ExecutionError& error) const;
  /// Position of the vehicle halfway [m], in the frame of the log.
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

/// A model and executions that were not used to fit it.
struct Unseen {
  const Observations* data = nullptr;
  ModelDocument model;
  std::vector<ExecutionError> errors;  ///< of the model on these executions
  size_t first_drive = 0;              ///< number of the rows' first drive among all logs
};

/// Typical and worst unseen executions with a band that contains nine of ten, and the places of all
/// errors.
/** The band is the residual noise of the fitted model propagated along the predicted path (scales
 * of the channels integrated over time, the heading's also as a lever), times the factor for which
 * it contains 90 % of the unseen executions at each time. No band for fewer than 20 executions. */
ShownExecutions shownExecutions(const std::vector<Unseen>& unseen, const ModelDocument& before,
                                const Noise& noise);

/// The scales for which encoders and gyro explain the poses of a drive best.
struct Reckoning {
  double speed = 1.0;        ///< ratio of ground speed to the mean of the encoders' track speeds
  double speed_lag = 0.0;    ///< [s] lag of the poses after the encoders
  double turning = 1.0;      ///< ratio of heading to gyro
  double turning_lag = 0.0;  ///< [s] lag of the heading after the gyro
  double drift = 0.0;        ///< [rad/s] of the heading at a gyro reading of 0
  double sideways = 0.0;     ///< [s] motion to the left per v omega
};

/// Fitted over a drive (least absolute deviations); nullopt without encoders, gyro or motion.
std::optional<Reckoning> fitReckoning(const Drive& drive);

/// Error floor: distance of dead reckoning with encoders and gyro from the measured poses.
/** Forward speed from the mean of the encoders, yaw rate from the gyro, lateral motion from their
 * product (without it a wide turn at speed would end farther off than a good model of the
 * commands); scales and lags are fitted to each drive; over the same fixes and scaled to the same
 * horizon as endErrors(). Dead reckoning has seen the motion, so a model that knows only the
 * commands is not expected to be better (except on ice, where tracks slip). nullopt if no
 * execution has encoders, gyro and poses. */
std::optional<EndErrors> deadReckoningFloor(const std::vector<Drive>& drives);

}  // namespace tread::gap
