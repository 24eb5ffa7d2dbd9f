// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "modules/learner/core/rules/learning_rule.hpp"
#include "tools/lab/experiment/first_executions.hpp"
#include "tools/lab/experiment/trials.hpp"

namespace tread::experiment {

/// Settings of an experiment.
struct ExperimentSettings {
  std::vector<std::string> rules;  ///< names of methods, see methodOf()
  learner::RuleConfig config;      ///< of all rules
  std::vector<Sequence> sequences;
  int64_t repetitions = 2000;  ///< of a transition; each drives all sequences once
  int64_t excitations = 40;    ///< excitation runs of a transition, which share the repetitions
  int64_t excitation = 200;    ///< executions on each surface of one
  uint64_t seed = 1;
  int threads = 1;  ///< results do not depend on it
  bool change_inside = false;
  std::vector<int> all_patterns_after{1, 2, 3, 10};  ///< executions, ascending
  size_t development = 30;                           ///< executions of Figure 4
  size_t drift = 300;                                ///< executions of the drift's figure

  size_t ruleIndex(const std::string& name) const;  ///< rules.size() if absent
};

/// One ordered pair of surfaces.
struct TransitionErrors {
  size_t from = 0;
  size_t to = 0;
  SequenceErrors sequences;
  std::vector<MethodErrors> all_patterns;  ///< by all_patterns_after
  std::vector<MethodErrors> development;   ///< by execution
  FirstExecutions first;                   ///< of random patterns
  /// remembered surfaces before the transition, mean over excitation runs
  std::vector<double> remembered;
};

/// Section V on one set of recordings.
struct ExperimentErrors {
  std::vector<TransitionErrors> transitions;  ///< from each surface to each other one, in order
  std::vector<MethodErrors> unchanged;        ///< by surface, in the long run, with random patterns
  std::vector<MethodErrors> unchanged_sequences;  ///< the same over the test sequences
  std::vector<FirstExecutions> unchanged_first;   ///< by surface
  /// Width of the pattern `watched` by rule, over executions on unchanged ground; see driveDrift().
  std::vector<std::vector<double>> drift;
};

/// The widest pattern that no sequence executes; nullopt if all are executed or straight.
std::optional<size_t> neverExecuted(const TrialGround& ground,
                                    const std::vector<Sequence>& sequences);

/// Progress callback (done, total), called from the threads, one at a time.
using Progress = std::function<void(size_t done, size_t all)>;

/// Runs all trials. Results do not depend on the number of threads.
ExperimentErrors runExperiment(const std::vector<TrialGround>& grounds,
                               const ExperimentSettings& settings, const Progress& progress);

}  // namespace tread::experiment
