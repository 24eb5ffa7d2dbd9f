// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/drive/drive_timeline.hpp"

namespace tread::why {

/// More lost messages within seconds mean a wrong counter.
inline constexpr int64_t kMostLost = 100'000;

/// The subject of a finding.
enum class FindingKind { kStop, kProcess, kMessages, kDetour, kGoal, kRefusal, kPrediction };
const char* nameOf(FindingKind kind);

/// A message of the log that supports a finding.
struct Evidence {
  double time = 0.0;  ///< [s] since the log began
  std::string channel;
  std::string words;
};

/// An event of the drive, its cause and its evidence. Each finding has evidence.
struct Finding {
  FindingKind kind = FindingKind::kStop;
  double time = 0.0;   ///< [s] since the log began: the moment to inspect
  double until = 0.0;  ///< [s] its end
  std::string cause;   ///< one word for programs: "ins_device", "planner_died"
  std::string sentence;
  std::vector<Evidence> evidence;
};

/// "ins_driver died and was started again".
std::string diedWords(const std::string& process, bool started_again);
/// Evidence of it: the first HEALTH of the next life, or the last one of this life.
Evidence deathEvidence(double time, const std::string& process, bool started_again);

/// A drive in numbers.
struct DriveFigures {
  double duration = 0.0;  ///< [s]
  double distance = 0.0;  ///< [m]
  int goals = 0, reached = 0;
  int stops = 0;  ///< unplanned
  int patterns = 0, aborted = 0, measured = 0;
  double error_position = 0.0, error_yaw = 0.0;   ///< median at the end of a pattern [m], [rad]
  double battery_begin = 0.0, battery_end = 0.0;  ///< [V]; NaN unknown
};

/// The findings about a drive.
struct Debrief {
  std::string name;
  std::string problem;  ///< of the log; empty = complete
  DriveFigures figures;
  std::vector<Finding> findings;  ///< in the order of time
  std::map<std::string, std::string> configs;

  /// The finding that ended the drive or disturbed it most; nullptr if there is none.
  const Finding* worst() const;
};

/// INS messages are thinned to this period [s].
inline constexpr double kInsStep = 0.1;
/// Analyses a drive.
Debrief debrief(const DriveTimeline& drive);

/// Unplanned stops, each with its cause.
std::vector<Finding> stopsOf(const DriveTimeline& drive);

/// Stretches with patterns that ended much further from their predictions than before, and patterns
/// without a measurement of the learner.
std::vector<Finding> patternFindingsOf(const DriveTimeline& drive);

/// A difference between two drives or their configurations.
struct Difference {
  std::string what;  ///< "planner.margins.growth", "patterns measured"
  std::string before;
  std::string now;
};

/// Keys with different values in the configurations, by process.
std::vector<Difference> configDifferences(const Debrief& before, const Debrief& now);
/// Figures that differ significantly, and causes that are new or gone.
std::vector<Difference> driveDifferences(const Debrief& before, const Debrief& now);

/// A page of text for the terminal. `at` [s]: only findings near this time; negative = all.
std::string textOf(const Debrief& debrief, double at);
/// The same as one HTML file; `other` may be null.
std::string htmlOf(const Debrief& debrief, const Debrief* other);
std::string jsonOf(const Debrief& debrief, const Debrief* other);
/// Differences as text.
std::string textOfDifferences(const Debrief& before, const Debrief& now);

}  // namespace tread::why
