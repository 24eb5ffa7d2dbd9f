// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "tools/experiment/experiment.hpp"

namespace tread::experiment {

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
