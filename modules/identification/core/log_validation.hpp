// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "common/report/text.hpp"
#include "modules/identification/core/drive.hpp"
#include "modules/identification/core/lag_table.hpp"

namespace tread::gap {

/// Notes about one log, in the order in which they were made.
class Diagnostics {
 public:
  explicit Diagnostics(std::string log) : log_(std::move(log)) {}

  /// Nothing can be concluded from the log.
  void fatal(const std::string& what) { notes_.push_back({log_, what, true}); }
  void note(const std::string& what) { notes_.push_back({log_, what, false}); }
  std::vector<LogNote> notes() { return std::move(notes_); }

 private:
  std::string log_;
  std::vector<LogNote> notes_;
};

/// A number with so many decimals, without "-0.0".
inline std::string digits(double value, int decimals = 1) {
  const std::string text = fixed(value, decimals);
  const bool zero = text.find_first_not_of("-0.") == std::string::npos;
  return zero && text[0] == '-' ? text.substr(1) : text;
}

/// Whether a drive's measurements belong together, before anything is fitted:
/// gyro against heading (sign, scale, offset of the clocks), motion against commands (sign, order
/// in time, clocks that jump), jumps, fixes, noise and bias at standstill, and what was driven.
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
void checkCommands(const Drive& drive, const std::vector<PoseIncrement>& increments,
                   Diagnostics& notes);
void checkPoses(const Drive& drive, const std::vector<PoseIncrement>& increments,
                Diagnostics& notes);
void describeStandstill(const Drive& drive, Diagnostics& notes);
void describeDriving(const Drive& drive, const std::vector<PoseIncrement>& increments,
                     Diagnostics& notes);

}  // namespace tread::gap
