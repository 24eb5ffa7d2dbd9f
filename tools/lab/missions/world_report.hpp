// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "tools/lab/missions/report.hpp"

namespace tread::missions {

/// What the planner plans with in an experiment: what a rule learns, the truth, or a part of each.
struct PatternSource {
  std::string name;                ///< as it was asked for
  std::string rule;                ///< of learning; empty = the configuration's
  std::optional<TrueShare> truth;  ///< what of the true patterns is in the planner's set
};

/// "RULE", "omniscient", "RULE+true_means" or "RULE+true_covariances"; nothing for another word.
std::optional<PatternSource> patternSourceOf(const std::string& word);

/// One line of a timed run.
std::string timedLineOf(const MissionResult& result);

/// Timed runs in given worlds as a whole.
struct TimedSummary {
  double success = 0.0, contact = 0.0, timeout = 0.0;  ///< [1] shares of the worlds
  double metric = 0.0;                                 ///< mean of navigationMetric()
  double time = 0.0;             ///< [s] mean clock of those that arrived; NaN without any
  double metres = 0.0;           ///< [m] mean way of those
  double clearance = 0.0;        ///< [m] median of the least clearance of a run
  double least_clearance = 0.0;  ///< [m] of all runs
  double stops = 0.0;            ///< a run
  double stood = 0.0;            ///< [s] a run, in those stops
  /// [m] mean standard deviations that the plans promised, of the end of the next pattern and of
  /// the whole plan; NaN without any.
  double next_sigma = 0.0, end_sigma = 0.0;
  double touches = 0.0;  ///< contacts a run that the plans' risk is, over the ways driven
  std::array<int, 3> expansions{};  ///< of a search: median, 90 and 99 %
};
TimedSummary timedSummaryOf(const std::vector<MissionResult>& results);

/// A metric less another one's in the same worlds.
struct PairedMetric {
  double mean = 0.0;
  double low = 0.0, high = 0.0;  ///< 95 % interval of the mean over the worlds
  int better = 0, worse = 0;     ///< worlds that differ by more than 0.01
};
PairedMetric pairedMetric(const std::vector<MissionResult>& mine,
                          const std::vector<MissionResult>& other);

/// A line a batch, and the differences to the first one; batches drove the same worlds.
void printWorlds(std::ostream& out, const std::vector<MissionBatch>& batches);

/// `worlds` and `summary`, of several batches in a list with their differences to the first one;
/// throws std::runtime_error with one clear line if it cannot be written.
void writeWorlds(const std::string& path, const std::vector<MissionBatch>& batches);

}  // namespace tread::missions
