// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tools/experiment/experiment.hpp"
#include "tools/experiment/tables.hpp"

namespace tread::experiment {

/// What the command line asks for.
struct Request {
  std::string world;                   ///< file; else `recordings` is used
  std::string recordings;              ///< folder
  std::string robot;                   ///< of a folder of drives
  std::vector<std::string> sessions;   ///< of it; empty = all that are comparable
  std::vector<std::string> sequences;  ///< "left,left,right"; empty = those of the world
  std::vector<std::string> rules;
  int64_t repetitions = 30'000;
  int64_t excitation = 200;  ///< executions on each surface that a bank meets before
  double memory = 0.5;       ///< [1] w of equation (2)
  uint64_t seed = 1;
  int threads = 1;
  int sets = 1;    ///< of a world: sets of recordings, from seeds that count up
  int length = 1;  ///< of a world: each command is held so many times as long
  bool change_inside = false;
  bool extras = false;  ///< twice as long patterns and changes inside a pattern, too
};

/// The same experiment on other terms, with fewer repetitions.
struct Variant {
  std::string words;
  Tables tables;
  std::vector<Tables> sets;
};

/// A request and its results.
struct Batch {
  Request request;
  Setting setting;
  ExperimentSettings settings;
  std::string source;              ///< the world or folder, in words
  std::vector<std::string> notes;  ///< about the recordings
  std::vector<Tables> sets;
  Tables tables;                          ///< of all sets of recordings together
  std::vector<Ground> grounds;            ///< of the first set of recordings
  ExperimentErrors first;                 ///< of it, for the pictures
  std::vector<ExcitationRun> excitation;  ///< of the rule bank, by surface it comes home to
  std::vector<Variant> variants;          ///< if the request wants extras
  double seconds = 0.0;                   ///< of the trials, without recording
};

/// Runs everything; throws an exception with one line for what cannot be done. progress(share of
/// the work that is done, 0..1).
Batch runBatch(const Request& request, const std::function<void(double)>& progress);

/// What the bank met before the transitions and holds; empty without that rule.
std::string textOfBank(const Batch& batch);

/// Key figures of the variants.
std::string textOfVariants(const Batch& batch);

/// Width of the never executed pattern after 100, 200, 300 executions on unchanged ground.
std::string textOfDrift(const Batch& batch);

/// Name of the pattern that is watched for drift; empty if there is none.
std::string watchedPattern(const Batch& batch);

/// Writes all files into a folder, which is made if needed.
void writeBatch(const std::string& folder, const Batch& batch);

/// The transition of the paper's figures: from cinder to grass if it is there, else the one that
/// costs most without learning. An index into errors.transitions.
size_t transitionOfFigures(const ExperimentErrors& errors, const ExperimentSettings& settings,
                           const std::vector<Ground>& grounds);

/// "cinder to grass".
std::string wordsOf(const TransitionErrors& transition, const std::vector<Ground>& grounds);

/// Figure 4: error and its deviation over executions without a reset, by rule (PNG).
void drawDevelopment(const std::string& path, const TransitionErrors& transition,
                     const ExperimentSettings& settings, const std::string& words);

/// Figure 5: how often which error occurs over the test sequences, by rule (PNG).
void drawDistributions(const std::string& path, const TransitionErrors& transition,
                       const ExperimentSettings& settings, const std::string& words);

/// How wide each rule predicts a pattern that is never executed, over executions on unchanged
/// ground (PNG).
void drawDrift(const std::string& path, const std::vector<std::vector<double>>& drift,
               const ExperimentSettings& settings, const std::string& watched);

}  // namespace tread::experiment
