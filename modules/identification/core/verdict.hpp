// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/observations.hpp"

namespace tread::gap {

/// Blocks of measured driving from which chance and cause can be told apart.
inline constexpr int kLeastBlocks = 10;

/// Blocks in which something was measured.
int measuredBlocks(const Observations& data);

/// Empty if rows are enough to conclude anything from; else one line that says how much to drive.
std::string tooLittleDriving(const Observations& data);

/// The headline of a finding whose effects, calibrated terms, adequacy and errors are known: one
/// verdict, with its reason where it is kCannotTell.
/** Adequate is a p-value above `adequacy_alpha`. Terms of the model that moved count if the end
 * error falls by more than the share `least_gain`. */
void judge(Finding& finding, double adequacy_alpha, double least_gain);

}  // namespace tread::gap
