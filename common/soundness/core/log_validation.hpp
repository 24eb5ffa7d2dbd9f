// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/soundness/core/drive.hpp"

namespace tread::gap {

/// The motion between two new poses of one segment.
struct PoseIncrement {
  size_t segment = 0;
  double begin = 0.0;   ///< [s]
  double end = 0.0;     ///< [s]
  Pose2 T_begin_end{};  ///< in the body frame of the begin
  Pose2 from{};         ///< T_map_body of the begin

  double duration() const { return end - begin; }
  double v() const { return T_begin_end.x / duration(); }        ///< [m/s] along
  double omega() const { return T_begin_end.yaw / duration(); }  ///< [rad/s] of the heading
};

/// How well one rate follows another with a lag.
struct LagMatch {
  double lag = 0.0;          ///< [s]
  double correlation = 0.0;  ///< at that lag
  double slope = 0.0;        ///< of the following rate over the leading one
  double offset = 0.0;       ///< of the following rate where the leading one is 0
  size_t rows = 0;
  double spread = 0.0;          ///< RMS of the following rate about its mean
  double leading_spread = 0.0;  ///< the same for the leading rate
};

/// [m/s] beyond which a pose has jumped.
inline double fastestOf(VehicleLayout layout) {
  return layout == VehicleLayout::kCar ? 70.0 : 8.0;
}

/// Whether a drive's measurements belong together, before anything is fitted:
/// motion against commands (command_check.hpp; order in time, clocks that jump or drift), gyro
/// against heading (sign, scale, offset of the clocks), changes on the way (frozen values, another
/// sign), jumps, fixes, noise and bias at standstill, and the kind of driving.
/** Only contradictions that no effect of the catalogue causes are fatal. The reader's own notes
 * (Drive::notes) are not repeated. */
std::vector<LogNote> validateLog(const Drive& drive);

/// Turning of the heading against the gyro; nullopt if one of them is missing or nothing turns.
/** lag: of the heading behind the gyro [s]; slope: heading over gyro; offset: -bias * slope. */
std::optional<LagMatch> headingBesideGyro(const Drive& drive);

/// Segments whose poses are not in the common frame: the heading turns differently from the gyro,
/// or the course deviates from the heading, far more than in the other segments. Indices in order.
/** Only for ten or more segments (a recording in steps); fewer are not conclusive. */
std::vector<size_t> brokenSegments(const Drive& drive);

/// Removes segments (and their executions).
void removeSegments(const std::vector<size_t>& segments, Drive& drive);

// Parts of validateLog().
void checkGyro(const Drive& drive, Diagnostics& notes);
/// Whether the motion follows the commands with a constant lag, as a vehicle's does.
void checkLags(const Drive& drive, const std::vector<PoseIncrement>& increments,
               Diagnostics& notes);

}  // namespace tread::gap
