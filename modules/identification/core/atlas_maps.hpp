// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/rows.hpp"

namespace tread::gap {

/// Mean residuals of each channel over speed and yaw rate, of two models.
std::vector<AtlasMap> residualMaps(const Rows& rows, const ModelDocument& before,
                                   const ModelDocument& after);

}  // namespace tread::gap
