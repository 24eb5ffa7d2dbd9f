// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/identification/core/finding.hpp"

namespace tread::gap {

/// Sets the verdict of a finding from its effects, calibrated terms, adequacy and errors, with the
/// reason for kCannotTell.
/** Adequate means a p-value above `adequacy_alpha`. Moved terms of the model count if the end error
 * falls by more than the share `least_gain`. A search that was cut short is kPartial with its
 * results, and kCannotTell without any. */
void judge(GapFinding& finding, double adequacy_alpha, double least_gain);

}  // namespace tread::gap
