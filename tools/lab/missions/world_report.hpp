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

/// Source of the planner's patterns in an experiment: a learning rule, the truth, or a mixture.
struct PatternSource {
  std::string name;                ///< as given
  std::string rule;                ///< learning rule; empty = that of the configuration
  std::optional<TrueShare> truth;  ///< true part of the planner's set
};

/// "RULE", "omniscient", "RULE+true_means" or "RULE+true_covariances"; nullopt for other words.
std::optional<PatternSource> patternSourceOf(const std::string& word);

/// One line of a timed run.
std::string timedLineOf(const MissionResult& result);

/// Summary of timed runs in given worlds.
struct TimedSummary {
  double success = 0.0, contact = 0.0, timeout = 0.0;  ///< [1] shares of the worlds
  double metric = 0.0;                                 ///< mean of navigationMetric()
  double time = 0.0;             ///< [s] mean clock of successful runs; NaN without any
  double metres = 0.0;           ///< [m] mean path length of those
  double clearance = 0.0;        ///< [m] median over runs of the least clearance
  double least_clearance = 0.0;  ///< [m] over all runs
  double stops = 0.0;            ///< per run
  double stood = 0.0;            ///< [s] per run, in those stops
  /// [m] mean predicted standard deviations of the end of the next pattern and of the whole plan;
  /// NaN without any
  double next_sigma = 0.0, end_sigma = 0.0;
  double touches = 0.0;  ///< expected contacts per run: the plans' risk summed over the driven path
  std::array<int, 3> expansions{};  ///< per search: median, 90 and 99 %
};
TimedSummary timedSummaryOf(const std::vector<MissionResult>& results);

/// Difference of the metrics of two batches in the same worlds.
struct PairedMetric {
  double mean = 0.0;
  double low = 0.0, high = 0.0;  ///< 95 % interval of the mean over the worlds
  int better = 0, worse = 0;     ///< worlds that differ by more than 0.01
};
PairedMetric pairedMetric(const std::vector<MissionResult>& mine,
                          const std::vector<MissionResult>& other);

/// One line per batch, and its difference to the first one; all batches drove the same worlds.
void printWorlds(std::ostream& out, const std::vector<MissionBatch>& batches);

/// `worlds` and `summary`; for several batches a list with the differences to the first one. Throws
/// std::runtime_error with one clear line if it cannot be written.
void writeWorlds(const std::string& path, const std::vector<MissionBatch>& batches);

}  // namespace tread::missions
