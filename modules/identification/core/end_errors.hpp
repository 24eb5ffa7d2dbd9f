// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/rows.hpp"

namespace tread::gap {

/// Prediction less measurement at the end of one execution, in the frame of its beginning.
struct EndError {
  size_t drive = 0;
  Execution execution;
  int block = 0;
  double position = 0.0;  ///< [m], scaled to the horizon
  double yaw = 0.0;       ///< [rad], scaled to the horizon, not wrapped
};

/// The horizon over which errors are told [s].
inline constexpr double kHorizon = 2.0;

/// Errors of a model on all executions that have fixes near their beginning and end.
/** The simulation runs open loop through the whole stretch, so that an execution begins in the
 * state that the commands before it led to. Lengths between .75 and 1.25 of the horizon count. */
std::vector<EndError> endErrors(const Rows& rows, const ModelDocument& model);
/// The same of motions that were simulated otherwise; one for each stretch, as Rows::simulate().
std::vector<EndError> endErrors(const Rows& rows,
                                const std::vector<std::vector<MotionSample>>& motions,
                                const MeasurementModel& measurement);

/// Median and root mean square of those that `counts`.
EndErrors summaryOf(const std::vector<EndError>& errors,
                    const std::function<bool(const EndError&)>& counts);

/// Executions as measured and as two models predict them.
class OverlayMaker {
 public:
  /// Simulates all drives of the rows once with either model; the rows must outlive it.
  OverlayMaker(const Rows& rows, const ModelDocument& before, const ModelDocument& after);

  Overlay of(const EndError& error) const;
  /// Where the vehicle was halfway [m], in the frame of the log.
  Eigen::Vector2d middleOf(const EndError& error) const;

 private:
  const Rows& rows_;
  MeasurementModel before_;
  MeasurementModel after_;
  /// Of each stretch.
  std::vector<std::vector<MotionSample>> old_motions_;
  std::vector<std::vector<MotionSample>> new_motions_;
  std::vector<std::vector<MotionSample>> measured_;
};

}  // namespace tread::gap
