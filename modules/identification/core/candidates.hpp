// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/identification/core/screening.hpp"

namespace tread::gap {

Excitation excitationOf(const Observations& data, const ModelDocument& model);

/// All directions of all effects of the catalogue that are off in a model.
/** Thresholds and change points get several (their gradient at 0 says nothing). Effects that
 * are another one under a second name are left to their groups. */
std::vector<Candidate> candidatesFor(const ModelDocument& model, const Excitation& excitation);

/// Those of a state, without what it has free already: also effects that are on and held by what is
/// known of them, to be freed; where numbers of the nominal model are free without limits, effects
/// that are the same under another name are left out.
std::vector<Candidate> candidatesFor(const FitState& state, const Excitation& excitation);

/// Those of one effect, even if it is another one under a second name.
std::vector<Candidate> candidatesOf(const std::string& effect, const FitState& state,
                                    const Excitation& excitation);

/// Takes out the candidates of these effects.
void leaveOut(std::vector<Candidate>& candidates, const std::vector<std::string>& effects);

/// A model with the candidate at its trial value.
ModelDocument tried(const ModelDocument& model, const Candidate& candidate);

/// The directions of candidates, rows x candidates.
Eigen::MatrixXd directionsOf(const Fitter& fitter, const FitState& state,
                             const std::vector<Candidate>& candidates);

/// Frees the candidate's parameters in a state, from its trial value scaled by first order.
void addCandidate(const Fitter& fitter, FitState& state, const Candidate& candidate, double size);

/// Whether a size is nothing beside what is typical.
bool isVanishing(const std::string& effect, const std::string& parameter, double size);

}  // namespace tread::gap
