// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/identification/core/finding.hpp"

namespace tread::gap {

/// The headline of a finding whose effects, calibrated terms, adequacy and errors are known: one
/// verdict (gap.md 4.3), with its reason where it is kCannotTell.
/** Adequate is a p-value above `adequacy_alpha`. Terms of the model that moved count if the end
 * error falls by more than the share `least_gain`. */
void judge(Finding& finding, double adequacy_alpha, double least_gain);

}  // namespace tread::gap
