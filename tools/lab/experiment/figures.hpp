// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tools/lab/experiment/experiment.hpp"
#include "tools/lab/experiment/ground.hpp"

namespace tread::experiment {

/// The transition of the paper's figures: cinder to grass if it exists, else the one with the
/// largest error without learning. An index into errors.transitions.
size_t transitionOfFigures(const ExperimentErrors& errors, const ExperimentSettings& settings,
                           const std::vector<TrialGround>& grounds);

/// For instance "cinder to grass".
std::string wordsOf(const TransitionErrors& transition, const std::vector<TrialGround>& grounds);

/// Figure 4: mean error and its standard deviation over executions without a reset, by rule (PNG).
void drawDevelopment(const std::string& path, const TransitionErrors& transition,
                     const ExperimentSettings& settings, const std::string& words);

/// Figure 5: histogram of the errors over the test sequences, by rule (PNG).
void drawDistributions(const std::string& path, const TransitionErrors& transition,
                       const ExperimentSettings& settings, const std::string& words);

/// Predicted width of a never executed pattern over executions on unchanged ground, by rule (PNG).
void drawDrift(const std::string& path, const std::vector<std::vector<double>>& drift,
               const ExperimentSettings& settings, const std::string& watched);

}  // namespace tread::experiment
