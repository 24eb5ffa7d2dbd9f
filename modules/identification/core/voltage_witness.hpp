// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"

namespace tread::gap {

/// Share of each intermittent effect that the battery voltage also shows; with 95 % intervals over
/// blocks.
/** A motor's speed is proportional to its voltage. No entry without a measured voltage, and for
 * effects that are not one factor on the motion that changes between blocks. */
std::map<std::string, VoltageWitness> voltageWitnesses(const Fitter& fitter, const FitState& state,
                                                       const std::vector<std::string>& effects);

}  // namespace tread::gap
