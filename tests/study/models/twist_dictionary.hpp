// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "tests/study/models/twist_regression.hpp"

namespace tread::gap {

/// Slip of a skid-steered vehicle as in the literature (Baril et al., DRIVE, arXiv 2309.10718,
/// "slip-BLR"): forward ~ v, sideways ~ v omega, turning ~ v omega, v, omega.
std::vector<TwistTerm> slipTerms();

/// A black box without causes: each part of the twist on the same polynomials, thresholds and
/// transients of the filtered twist, the command and the previous command.
/** For pieces in units of twice their root mean square, so that thresholds at 0.5 and 1 are within
 * the driving. */
std::vector<TwistTerm> blackBoxTerms();

}  // namespace tread::gap
