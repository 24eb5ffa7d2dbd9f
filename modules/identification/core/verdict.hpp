// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/search.hpp"

namespace tread::gap {

/// Blocks of measured driving from which chance and cause can be told apart.
inline constexpr int kLeastBlocks = 10;

/// Empty if rows are enough to conclude anything from; else one line that says how much to drive.
std::string tooLittleDriving(const Observations& data);

/// The model that a search ended with: its effects and terms with their 95 % intervals, covariance
/// and envelope, and the effects that the drive could not have shown.
/** `before` is the model that the search began with. */
IdentifiedModel identifiedModel(const Fitter& fitter, const ModelDocument& before,
                                const SearchSettings& settings, const SearchResult& result);

/// The headline of a finding whose effects, calibrated terms, adequacy and errors are known: one
/// verdict, with its reason where it is kCannotTell.
/** Adequate is a p-value above `adequacy_alpha`. Terms of the model that moved count if the end
 * error falls by more than the share `least_gain`. */
void judge(Finding& finding, double adequacy_alpha, double least_gain);

}  // namespace tread::gap
