// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <iomanip>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
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

/// Notes about one log, in the order of their making.
class Diagnostics {
 public:
  explicit Diagnostics(std::string log) : log_(std::move(log)) {}

  /// The log is unusable.
  void fatal(const std::string& what) { notes_.push_back({log_, what, true}); }
  void note(const std::string& what) { notes_.push_back({log_, what, false}); }
  /// The same, for commands against the motion.
  void contradiction(const std::string& what) { notes_.push_back({log_, what, true, true}); }
  void following(const std::string& what) { notes_.push_back({log_, what, false, true}); }
  std::vector<LogNote> notes() { return std::move(notes_); }

 private:
  std::string log_;
  std::vector<LogNote> notes_;
};

/// A number with this many decimals.
inline std::string fixed(double value, int decimals) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << value;
  return text.str();
}

/// The same without "-0.0".
inline std::string digits(double value, int decimals = 1) {
  const std::string text = fixed(value, decimals);
  const bool zero = text.find_first_not_of("-0.") == std::string::npos;
  return zero && text[0] == '-' ? text.substr(1) : text;
}

/// [m/s] beyond which a pose has jumped.
inline double fastestOf(VehicleLayout layout) {
  return layout == VehicleLayout::kCar ? 70.0 : 8.0;
}

/// The largest of the commands that move the vehicle.
double largestCommand(const Drive& drive);
/// Number of different commands, to a hundredth of the largest one.
size_t differentCommands(const Drive& drive);

/// Checks the measurements of a drive for consistency before any fit:
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
/// Signals that are valid in one part of the drive only: frozen, inverted or turned in the other.
void checkMidway(const Drive& drive, const std::vector<PoseIncrement>& increments,
                 Diagnostics& notes);
void checkPoses(const Drive& drive, const std::vector<PoseIncrement>& increments,
                Diagnostics& notes);
void describeStandstill(const Drive& drive, Diagnostics& notes);
void describeDriving(const Drive& drive, const std::vector<PoseIncrement>& increments,
                     Diagnostics& notes);

}  // namespace tread::gap
