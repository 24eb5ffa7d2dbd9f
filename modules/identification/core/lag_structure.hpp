// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/identification/core/search.hpp"

namespace tread::gap {

/// Chooses anew which lags there are between command and motion, once the rest is known.
/** A lag of the drive, of the yaw rate, of the speed: a search that goes step by step takes the
 * first one that helps, and bends the others to it. The structures are fitted with everything else;
 * another one takes over if it is better on blocks left out by more than a standard error and 10
 * nats, and one lag takes the place of two if it is not worse by both. True if one did. */
bool chooseLags(const SearchState& search);

}  // namespace tread::gap
