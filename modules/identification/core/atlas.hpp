// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/observations.hpp"

namespace tread::gap {

/// Where the residuals of two models are: curves of every channel over every variable, and maps
/// over speed and yaw rate.
/** The interval of a curve's cell is from the scatter of its blocks' means; cells that exclude 0
 * after correction for the number of cells (Bonferroni, 5 %) are marked. */
ResidualAtlas residualAtlas(const Observations& observations, const ModelDocument& before,
                            const ModelDocument& after);

}  // namespace tread::gap
