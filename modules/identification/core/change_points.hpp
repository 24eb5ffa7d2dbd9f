// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "modules/identification/core/fit.hpp"

namespace tread::gap {

/// Whether a strength of a change point is not 0.
bool hasChanged(const Effect& effect, const ChangePoint& change, const ModelDocument& model);

/// Paths of the change points at which effects of a model that are on begin to act.
std::vector<std::string> changePointsOn(const ModelDocument& model);

/// Moves a change point to where the loss is least, all else as it is.
/** The loss over its time is not smooth (each time concerns other data), so it is searched, not
 * followed downhill: halving steps down to a quarter of a second. */
void refineChangePoint(const Fitter& fitter, FitState& state, const std::string& path,
                       const std::vector<char>& mask);

/// Times between which the loss stays within `allowed` nats of the state's [s].
std::pair<double, double> changePointInterval(const Fitter& fitter, const FitState& state,
                                              const std::string& path,
                                              const std::vector<char>& mask, double allowed);

}  // namespace tread::gap
