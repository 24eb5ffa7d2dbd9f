// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/rows.hpp"

namespace tread::gap {

/// Where the residuals of two models are: every channel over every variable, in cells.
/** A cell's interval is from the scatter of its blocks' means; cells that exclude 0 after
 * correction for the number of cells (Bonferroni, 5 %) are marked. */
std::vector<AtlasCurve> residualAtlas(const Rows& rows, const ModelDocument& before,
                                      const ModelDocument& after);

}  // namespace tread::gap
