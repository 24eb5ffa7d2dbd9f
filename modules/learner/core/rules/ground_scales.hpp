// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/learner/core/rules/surface.hpp"

namespace tread::learner {

// The distance of a new ground from the expected one is itself unknown: each combination of these
// values is a scale of a bank, with a prior weight. Chosen on the simulated worlds, on directions
// of `omni` that are not in its recordings, and on real drives; none of these decided alone. Which
// scales are real is learned from the grounds that were met.

/// For a ground that was not met yet. `lever` [m] converts a yaw bias over its path into a loss on
/// one side. `share` scales all variances, if something is known of the vehicle.
VelocityBank::Scales velocityScalesOfNewGround(double share);
YawBank::Scales yawScalesOfNewGround(double lever, double share);
/// For the ground on which the shipped set was made: as shipped, except for the set's errors.
VelocityBank::Scales velocityScalesAsShipped();
YawBank::Scales yawScalesAsShipped(double lever);

}  // namespace tread::learner
