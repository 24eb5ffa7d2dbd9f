// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/recordings/imported_log.hpp"
#include "modules/learner/core/change_watch.hpp"
#include "modules/learner/core/rules/learning_rule.hpp"
#include "tools/robot/import/cut_drive.hpp"

// Errors of rules when the ground changes within a run, and the delay until the change is noticed.
//   1. Runs under one command are cut into pieces (tools/robot/import/cut_drive.hpp). The first
//      `known` of them without a change of ground are averaged into the initial set of a rule, one
//      pattern. The scatter of pieces is pooled over all runs, in proportion to their command.
//   2. For each piece a rule predicts, is compared, and learns.
//   3. Errors are grouped by the time since the last change: before any change, in the piece with
//      the change, in the following ones.
//   4. During a piece learner::ChangeWatch compares it with the rule's expectation; the rule learns
//      from a detected change. A detection before any change is a false alarm. A change counts as
//      real if the mean twist of the 2 s after it differs from that of the 2 s before by more than
//      a tenth of the speed.
// Units: m, rad, s.
namespace tread::experiment {

/// Rules, and parameters of the runs.
struct CrossingSettings {
  std::vector<std::string> rules{"off", "single", "multi_model", "rls2", "rls3"};
  learner::RuleConfig config;
  learner::ChangeLimits test;
  import::CutLayout cut{1.0, 1.2, 0.0, 1};
  size_t known = 2;       ///< pieces in a run's initial set
  double border = 0.0;    ///< [m] uncertainty of a border's position
  double shortest = 0.5;  ///< [s] shorter grounds are ignored
};

/// A change of ground inside a run.
struct GroundChange {
  double time = 0.0;  ///< [s]
  std::string from, to;
  bool real = false;   ///< the motion differs
  double early = 0.0;  ///< [s] by which the border may be earlier
};

/// Consecutive pieces of a run, from the first known one on.
struct CrossingRun {
  std::vector<import::CutPiece> pieces;
  std::vector<GroundChange> changes;  ///< after the known pieces
};

/// Usable runs of a drive, and reasons for the unusable ones.
struct CrossingDrives {
  CommandChannels channels;
  std::vector<CrossingRun> runs;
  std::vector<std::string> notes;
};

/// Throws RecordingError if the drive's commands cannot be cut.
CrossingDrives crossingRuns(const recordings::RecordedDrive& drive,
                            const CrossingSettings& settings);

/// Phase of a piece relative to the last change of ground.
enum class Phase : size_t { kBefore, kChanging, kSecond, kThird, kLater };
inline constexpr size_t kPhases = 5;
extern const std::array<const char*, kPhases> kPhaseNames;

/// Errors of pieces in one phase under one rule.
struct PhaseErrors {
  size_t pieces = 0;
  double metres = 0.0;
  double position = 0.0;  ///< [m] sum of end errors
  size_t regions = 0;     ///< pieces with a stated region
  size_t inside = 0;

  double perMetre() const { return position / metres; }
};

/// Detections under one rule while pieces ran.
struct Notices {
  size_t runs = 0;             ///< in which the rule has an expectation for the running piece
  size_t false_runs = 0;       ///< with a false alarm before any change
  double undisturbed = 0.0;    ///< [s] tested before any change
  size_t real = 0;             ///< tested real changes
  std::vector<double> delays;  ///< [s] of those detected within kLatest
  static constexpr double kLatest = 1.6;

  size_t within(double seconds) const;
};

/// Results of one rule on all runs.
struct CrossingErrors {
  std::string rule;
  std::array<PhaseErrors, kPhases> phases;
  Notices notices;
};

/// All rules on all runs; throws std::invalid_argument for an unknown rule, RecordingError if no
/// run is left.
std::vector<CrossingErrors> driveCrossings(const std::vector<CrossingDrives>& drives,
                                           const CrossingSettings& settings);

}  // namespace tread::experiment
