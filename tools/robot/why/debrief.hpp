// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/drive/drive_timeline.hpp"

namespace tread::why {

/// More messages than that are not lost within seconds: a broken number.
inline constexpr int64_t kMostLost = 100'000;

/// What a finding is about.
enum class FindingKind { kStop, kProcess, kMessages, kDetour, kGoal, kRefusal, kPrediction };
const char* nameOf(FindingKind kind);

/// A message of the log that speaks for a finding.
struct Evidence {
  double time = 0.0;  ///< [s] since the log began
  std::string channel;
  std::string words;
};

/// Something that happened in the drive, why, and what says so. None stands without evidence.
struct Finding {
  FindingKind kind = FindingKind::kStop;
  double time = 0.0;   ///< [s] since the log began: the moment to look at
  double until = 0.0;  ///< [s] it lasted until then
  std::string cause;   ///< one word for programs: "ins_device", "planner_died"
  std::string sentence;
  std::vector<Evidence> evidence;
};

/// A drive in numbers.
struct DriveFigures {
  double duration = 0.0;  ///< [s]
  double distance = 0.0;  ///< [m]
  int goals = 0, reached = 0;
  int stops = 0;  ///< that nobody had planned
  int patterns = 0, aborted = 0, measured = 0;
  double error_position = 0.0, error_yaw = 0.0;   ///< median at the end of a pattern [m], [rad]
  double battery_begin = 0.0, battery_end = 0.0;  ///< [V]; NaN unknown
};

/// What to say about a drive.
struct Debrief {
  std::string name;
  std::string problem;  ///< of the log; empty = whole
  DriveFigures figures;
  std::vector<Finding> findings;  ///< in the order of time
  std::map<std::string, std::string> configs;

  /// The finding that ended the drive or disturbed it most; nullptr where all went well.
  const Finding* worst() const;
};

/// Of INS messages that come faster a debrief needs no more [s].
inline constexpr double kInsStep = 0.1;
/// Looks through a drive.
Debrief debrief(const DriveTimeline& drive);

/// The stops that nobody had planned, each with its cause.
std::vector<Finding> stopsOf(const DriveTimeline& drive);

/// Stretches in which patterns ended much further from their predictions than before, and patterns
/// of which the learner took no measurement.
std::vector<Finding> patternFindingsOf(const DriveTimeline& drive);

/// The value in the middle; NaN of none.
double median(std::vector<double> values);

/// How a drive or its configuration differs from another one.
struct Difference {
  std::string what;  ///< "planner.margins.growth", "patterns measured"
  std::string before;
  std::string now;
};

/// Keys of the configurations that differ, process by process.
std::vector<Difference> configDifferences(const Debrief& before, const Debrief& now);
/// Figures that differ by more than chance would have it, and causes that are new or gone.
std::vector<Difference> driveDifferences(const Debrief& before, const Debrief& now);

/// A page of text for the terminal. `at` [s]: only what lies near; negative = all.
std::string textOf(const Debrief& debrief, double at);
/// The same as one HTML file; `other` may be null.
std::string htmlOf(const Debrief& debrief, const Debrief* other);
std::string jsonOf(const Debrief& debrief, const Debrief* other);
/// Differences as text.
std::string textOfDifferences(const Debrief& before, const Debrief& now);

}  // namespace tread::why
