// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "tests/study/models/twist_regression.hpp"

namespace tread::gap {

/// The slip of a skid-steered vehicle as the literature regresses it (Baril et al., DRIVE,
/// arXiv 2309.10718, "slip-BLR"): forward ~ v, sideways ~ v omega, turning ~ v omega, v, omega.
std::vector<TwistTerm> slipTerms();

/// What anybody would throw in who does not ask for causes: each part of the twist on the same
/// polynomials, thresholds and transients of the filtered twist, the command and the one before.
/** Made for pieces in twice their root mean square, where thresholds at 0.5 and 1 lie within the
 * driving. */
std::vector<TwistTerm> blackBoxTerms();

}  // namespace tread::gap
