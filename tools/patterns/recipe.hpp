// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/config/config_reader.hpp"
#include "common/pattern/pattern.hpp"
#include "common/vehicle/model.hpp"

namespace tread::patterns {

/// Makes a pattern set from a recipe (see config/patterns/recipes): commands from the recipe,
/// predictions from the model.
/** Ids count from 1 in the order of the recipe; `mirror` adds the pattern with left and right
 * exchanged. Predictions are rounded to micrometres and microradians. Throws ConfigError at
 * file:line for what the recipe gets wrong; among that is a pattern that does not hold its exit
 * class's steady command for three lags (and the delay) at its end. */
PatternSet makeSet(ConfigReader recipe, const VehicleModel& model);

}  // namespace tread::patterns
