// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "common/execution/execution_record.hpp"
#include "common/geometry/track.hpp"
#include "common/pattern/pattern.hpp"

// How an execution becomes a measured trajectory M:
//   1. the record is checked (completed, times consistent with the pattern, the pattern's own
//      commands);
//   2. the track is cut at the execution's start and interpolated at the pattern's sample times;
//   3. invalid measurements are refused, with a reason. There is no test for unusual motion,
//      because it would reject ice: only physically impossible and incomparable motion is refused.
namespace tread {

/// Why an execution is not learned from.
enum class Gate {
  kNone,            ///< it is a fair measurement
  kAborted,         ///< did not run to its end
  kUnknownPattern,  ///< not in the set
  kRecord,          ///< contradictory times
  kCommands,        ///< the motors received other commands than the pattern's
  kNoTrack,         ///< no INS data at its start
  kInsGap,          ///< INS silent for too long
  kCoveredTime,     ///< the INS covers too little of it
  kNotFinite,       ///< lost poses
  kSpeed,           ///< faster than the vehicle can be
  kNoMotion,        ///< should have moved but did not
  kEntryTwist,      ///< it began neither with the commands nor with the twist of its entry class
  kSlope,           ///< the ground was too steep
};

/// Short name of a gate, for counters and reports.
const char* gateName(Gate gate);

/// Limits of a valid measurement.
struct MeasurementLimits {
  int64_t max_gap_us = 300'000;   ///< [us] between two INS poses
  double min_covered = 0.80;      ///< [1] share of the samples that the INS must cover
  int64_t shortest_us = 400'000;  ///< [us] of a beginning: shorter ones are mostly INS noise
  double max_speed = 0.0;         ///< [m/s] of the vehicle; 0 = the largest in the shipped set
  double speed_margin = 1.5;      ///< [1] poses faster than this times max_speed are jumps
  double min_motion = 0.03;       ///< [m] size of the box below which the robot did not move
  double min_turn = 0.03;         ///< [rad] the same for yaw
  /// [us] before the start over which the entry twist is measured
  int64_t entry_window_us = 200'000;
  /// [m/s] allowed deviation of v_x and v_y from the class; infinite = any
  double entry_speed = 0.40;
  double entry_yaw_rate = 0.50;  ///< [rad/s] allowed deviation of omega; infinite = any
  double max_slope = 0.20;       ///< [rad] mean inclination during the execution
};

/// An execution as described by its record.
struct ExecutionCut : ExecutionRecord {
  /// Only its beginning, up to `ended`: it is still running, or was stopped early.
  bool beginning = false;
  /// The entry class's command was held for long enough before it: the entry is the class's,
  /// whatever twist that gives on this ground.
  bool steady_before = false;
  /// A command that differed from the pattern's, in words; empty = none.
  std::string unexpected_command{};
};

/// Conditions that may change the motion besides the ground; NaN = unknown.
struct Context {
  Tilt tilt;                        ///< mean
  double voltage = Tilt::kUnknown;  ///< [V] mean, of the battery
  /// v_body before the start.
  Twist2 entry{Tilt::kUnknown, Tilt::kUnknown, Tilt::kUnknown};
  /// Periods after its start at which the ground changed; negative: no change detected.
  int changed_after = -1;
};

/// M and the quantities measured with it. NaN = not measured.
struct Measurement {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  Gate gate = Gate::kNone;
  std::string reason;             ///< of the gate: quantity, value, limit
  std::vector<Pose2> trajectory;  ///< M at the pattern's sample times; empty if there is none
  size_t covered = 0;  ///< leading samples that are measured; the rest continues as predicted
  Context context;
  double path_length = kUnknown;  ///< [m] driven over the covered samples

  bool fair() const { return gate == Gate::kNone; }
  /// Whether the end pose itself was measured.
  bool complete() const { return !trajectory.empty() && covered == trajectory.size(); }
};

/// Cuts and gates one execution of a pattern.
/** `max_speed` of the limits must be set; `period_us` is that of the pattern's set. */
Measurement measure(const TrackHistory& history, const ExecutionCut& cut,
                    const MotionPattern& pattern, const MotionClass& entry_class, int64_t period_us,
                    const MeasurementLimits& limits);

/// Length and width [m] of the box around the start pose and all poses, and the interval of yaw
/// [rad].
Eigen::Array3d boundingBox(const std::vector<Pose2>& trajectory);

/// The largest speed of classes, commands (if they are speeds) and predicted steps of a set [m/s].
double largestSpeed(const PatternSet& set);

}  // namespace tread
