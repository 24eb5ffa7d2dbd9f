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

// What rules err where the ground changes inside a run, and how soon the change is noticed.
//   1. Runs under one command are cut into pieces (tools/robot/import/cut_drive.hpp). The first
//   `known`
//      of them without a change of ground are averaged: that is the set that a rule begins with,
//      one pattern. How pieces scatter is pooled over all runs, in proportion to their command.
//   2. Piece after piece a rule predicts, is compared, and learns.
//   3. Errors are told by how long ago the ground changed last: before any change, in the piece in
//      which it does, in the next ones.
//   4. While a piece is driven, learner::ChangeWatch compares it with what the rule expects; the
//   rule
//      learns from what it noticed. A change that is noticed before any is a false one. A change
//      counts as real if the mean twist of the two seconds after it differs from that of the two
//      before by more than a tenth of the speed.
// Units: m, rad, s.
namespace tread::experiment {

/// Which rules, and how runs are cut.
struct CrossingSettings {
  std::vector<std::string> rules{"off", "single", "multi_model", "rls2", "rls3"};
  learner::RuleConfig config;
  learner::ChangeLimits test;
  import::CutLayout cut{1.0, 1.2, 0.0, 1};
  size_t known = 2;       ///< pieces that the set of a run comes from
  double border = 0.0;    ///< [m] how far a border may lie from where the columns say
  double shortest = 0.5;  ///< [s] grounds that are left again sooner are no change
};

/// A change of ground inside a run.
struct GroundChange {
  double time = 0.0;  ///< [s]
  std::string from, to;
  bool real = false;   ///< the motion is another one
  double early = 0.0;  ///< [s] by which the border may come before that time
};

/// Pieces of a run one after the other, from the first known one on.
struct CrossingRun {
  std::vector<import::CutPiece> pieces;
  std::vector<GroundChange> changes;  ///< after the known pieces
};

/// Runs of a drive that can be used, and why others cannot.
struct CrossingDrives {
  CommandChannels channels;
  std::vector<CrossingRun> runs;
  std::vector<std::string> notes;
};

/// Throws RecordingError if the drive's commands cannot be cut.
CrossingDrives crossingRuns(const recordings::RecordedDrive& drive,
                            const CrossingSettings& settings);

/// When a piece is, by the last change of ground.
enum class Phase : size_t { kBefore, kChanging, kSecond, kThird, kLater };
inline constexpr size_t kPhases = 5;
extern const std::array<const char*, kPhases> kPhaseNames;

/// Pieces of one phase under one rule.
struct PhaseErrors {
  size_t pieces = 0;
  double metres = 0.0;
  double position = 0.0;  ///< [m] sum of the errors of ends
  size_t regions = 0;     ///< pieces for which the rule stated a region
  size_t inside = 0;

  double perMetre() const { return position / metres; }
};

/// What was noticed under one rule while pieces ran.
struct Notices {
  size_t runs = 0;             ///< if the rule knows what to expect of a running piece
  size_t false_runs = 0;       ///< with an alarm before any change
  double undisturbed = 0.0;    ///< [s] that were tested before any change
  size_t real = 0;             ///< real changes that were tested
  std::vector<double> delays;  ///< [s] of those that were noticed within kLatest
  static constexpr double kLatest = 1.6;

  size_t within(double seconds) const;
};

/// One rule on all runs.
struct CrossingErrors {
  std::string rule;
  std::array<PhaseErrors, kPhases> phases;
  Notices notices;
};

/// All rules on all runs; throws std::invalid_argument for a rule that is not known, RecordingError
/// where no run is left.
std::vector<CrossingErrors> driveCrossings(const std::vector<CrossingDrives>& drives,
                                           const CrossingSettings& settings);

/// How many runs and changes there are.
std::string textOf(const std::vector<CrossingDrives>& drives);
/// Errors, regions and notices as a table for people; errors and notices for programs.
std::string textOf(const std::vector<CrossingErrors>& errors);
std::string csvOf(const std::vector<CrossingErrors>& errors);
std::string noticedCsvOf(const std::vector<CrossingErrors>& errors);

}  // namespace tread::experiment
