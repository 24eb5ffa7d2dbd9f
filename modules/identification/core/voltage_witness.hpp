// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"

namespace tread::gap {

/// How much of each effect that comes and goes with time the battery voltage falls by, too; with
/// 95 % intervals over blocks.
/** A motor is slower in proportion to its voltage. Nothing where no voltage is measured, and of
 * effects that are not one factor on the motion that changes from block to block. */
std::map<std::string, VoltageWitness> voltageWitnesses(const Fitter& fitter, const FitState& state,
                                                       const std::vector<std::string>& effects);

}  // namespace tread::gap
