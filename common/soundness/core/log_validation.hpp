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

/// One rate of all: &PoseIncrement::v or &PoseIncrement::omega.
std::vector<double> ratesOf(const std::vector<PoseIncrement>& increments,
                            double (PoseIncrement::*rate)() const);

/// A running sum over time, within one segment, linear between its points.
class RunningSum {
 public:
  /// Appends a rate that holds from `begin` to `end` [s]; a pause before it ends what is known.
  void add(double begin, double end, double rate);
  /// Mean rate over an interval; nothing if it is not known all along.
  std::optional<double> mean(double begin, double end) const;

 private:
  struct Point {
    double time;
    double sum;
    size_t piece;  ///< between pieces nothing is known
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

/// How well one rate follows another one, later by a lag.
struct LagMatch {
  double lag = 0.0;          ///< [s]
  double correlation = 0.0;  ///< at that lag
  double slope = 0.0;        ///< of the rate that follows, over the other one
  double offset = 0.0;       ///< of the rate that follows where the other one is 0
  size_t rows = 0;
  double spread = 0.0;          ///< RMS of the rate that follows about its mean
  double leading_spread = 0.0;  ///< the same of the other one
};

/// Rates of increments beside another rate at many lags; increments count that speak at all lags.
class LagTable {
 public:
  /// `rates` of the increments; `sums` of the rate that they follow, which is read `lag` earlier.
  LagTable(const std::vector<PoseIncrement>& increments, const std::vector<double>& rates,
           const RunningSums& sums, std::vector<double> lags);

  /// The match at one of the lags over increments [first, last); nothing where less than a third
  /// of the increments speak, or nothing moves.
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

/// Notes about one log, in the order in which they were made.
class Diagnostics {
 public:
  explicit Diagnostics(std::string log) : log_(std::move(log)) {}

  /// Nothing can be concluded from the log.
  void fatal(const std::string& what) { notes_.push_back({log_, what, true}); }
  void note(const std::string& what) { notes_.push_back({log_, what, false}); }
  /// The same of commands beside the motion.
  void contradiction(const std::string& what) { notes_.push_back({log_, what, true, true}); }
  void following(const std::string& what) { notes_.push_back({log_, what, false, true}); }
  std::vector<LogNote> notes() { return std::move(notes_); }

 private:
  std::string log_;
  std::vector<LogNote> notes_;
};

/// A number with so many decimals.
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
/// Different commands, to a hundredth of the largest one.
size_t differentCommands(const Drive& drive);

/// Whether a drive's measurements belong together, before anything is fitted:
/// motion against commands (command_check.hpp; order in time, clocks that jump or drift), gyro
/// against heading (sign, scale, offset of the clocks), what changes on the way (frozen, another
/// sign), jumps, fixes, noise and bias at standstill, and what was driven.
/** Fatal are only contradictions that no effect of the catalogue makes. The reader's own notes
 * (Drive::notes) are not repeated. */
std::vector<LogNote> validateLog(const Drive& drive);

/// How the heading turns beside the gyro; nothing where one of them is missing or nothing turns.
/** lag: of the heading behind the gyro [s]; slope: heading over gyro; offset: -bias * slope. */
std::optional<LagMatch> headingBesideGyro(const Drive& drive);

/// Segments whose poses do not belong to one frame: the heading turns otherwise than the gyro, or
/// the way leads elsewhere than the heading, far more than in the others. Indices in order.
/** Only among ten or more segments (a recording in steps), as others do not tell. */
std::vector<size_t> brokenSegments(const Drive& drive);

/// Takes out segments (and their executions).
void removeSegments(const std::vector<size_t>& segments, Drive& drive);

// Parts of validateLog().
void checkGyro(const Drive& drive, Diagnostics& notes);
/// Whether the motion follows the commands by one lag, as a vehicle does.
void checkLags(const Drive& drive, const std::vector<PoseIncrement>& increments,
               Diagnostics& notes);
/// What was sound and is not any more, or not yet: frozen, of another sign, turned.
void checkMidway(const Drive& drive, const std::vector<PoseIncrement>& increments,
                 Diagnostics& notes);
void checkPoses(const Drive& drive, const std::vector<PoseIncrement>& increments,
                Diagnostics& notes);
void describeStandstill(const Drive& drive, Diagnostics& notes);
void describeDriving(const Drive& drive, const std::vector<PoseIncrement>& increments,
                     Diagnostics& notes);

}  // namespace tread::gap
