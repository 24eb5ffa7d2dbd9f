// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/identification/core/search.hpp"

namespace tread::gap {

/// Reconsiders the choice of lags between command and motion, once the rest is known.
/** A step-by-step search takes the first lag that helps (of the drive, the yaw rate or the speed),
 * and adapts the others to it. The alternatives are fitted with everything else; one replaces the
 * present choice if it is better on held-out blocks by more than a standard error and 10 nats, and
 * one lag replaces two if it is not worse by both. True if one did. */
bool chooseLags(const SearchState& search);

}  // namespace tread::gap
