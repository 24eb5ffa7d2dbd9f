// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/experiment/trials.hpp"

namespace tread::experiment {

/// What to compare, on what, how often.
struct ExperimentSettings {
  std::vector<std::string> rules;  ///< names of contestants; "off" and "omniscient" among them
  learner::RuleConfig config;      ///< of all rules
  std::vector<Sequence> sequences;
  int64_t repetitions = 30'000;  ///< each drives all sequences once
  int64_t excitation = 200;      ///< executions on each surface that a bank meets before
  uint64_t seed = 1;
  int threads = 1;  ///< no influence on any number
  bool change_inside = false;
  std::vector<int> all_patterns_after{1, 2, 3, 10};  ///< executions, ascending
  size_t development = 30;                           ///< executions of Figure 4
  size_t drift = 300;                                ///< executions of the drift's figure

  size_t ruleIndex(const std::string& name) const;  ///< rules.size() if it is not there
};

/// One ordered pair of surfaces.
struct TransitionErrors {
  size_t from = 0;
  size_t to = 0;
  SequenceErrors sequences;
  std::vector<Errors> all_patterns;  ///< by all_patterns_after
  std::vector<Errors> development;   ///< by execution
};

/// Section V on one set of recordings.
struct ExperimentErrors {
  std::vector<TransitionErrors> transitions;  ///< from each surface to each other one, in order
  std::vector<Errors> unchanged;              ///< by surface, in the long run, random patterns
  std::vector<Errors> unchanged_sequences;    ///< the same over the test sequences
  /// Width of the pattern `watched` by rule, over executions on unchanged ground; see driveDrift().
  std::vector<std::vector<double>> drift;
};

/// The widest pattern of a set that no sequence executes; nothing if all are executed or straight.
std::optional<size_t> neverExecuted(const Ground& ground, const std::vector<Sequence>& sequences);

/// Parts done and parts in all; called from the threads, one at a time.
using Progress = std::function<void(size_t done, size_t all)>;

/// Runs all trials. Same settings and grounds, same bytes, for any number of threads.
ExperimentErrors runExperiment(const std::vector<Ground>& grounds,
                               const ExperimentSettings& settings, const Progress& progress);

/// Runs tasks on some threads; the first exception of one is thrown again here.
void runTasks(const std::vector<std::function<void()>>& tasks, int threads,
              const Progress& progress);

}  // namespace tread::experiment
