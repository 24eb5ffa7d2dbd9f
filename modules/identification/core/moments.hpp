// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "modules/identification/core/fit.hpp"

namespace tread::gap {

/// Moves the moment of a change to where the loss is least, all else as it is.
/** The loss over a moment is not smooth (each moment concerns other rows), so it is searched, not
 * followed downhill: halving steps down to a quarter of a second. */
void refineMoment(const Fitter& fitter, FitState& state, const std::string& path,
                  const std::vector<char>& mask);

/// Moments between which the loss stays within `allowed` nats of the state's [s].
std::pair<double, double> momentInterval(const Fitter& fitter, const FitState& state,
                                         const std::string& path, const std::vector<char>& mask,
                                         double allowed);

}  // namespace tread::gap
