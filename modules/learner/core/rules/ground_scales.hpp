// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/learner/core/rules/surface.hpp"

namespace tread::learner {

// How far a ground may lie from the one that is expected is itself not known: every combination of
// these is a scale of a bank, weighted by what is expected beforehand. Chosen on the simulated
// worlds, on directions of `omni` that are not in its recordings, and on real drives, where none of
// them decided by itself; which of them grounds have is learned from those that were met.

/// Of a ground that was not met yet. `lever` [m] turns a yaw bias over its way into a loss on one
/// side. `share` of all variances, where something is known of the vehicle.
VelocityBank::Scales velocityScalesOfNewGround(double share);
YawBank::Scales yawScalesOfNewGround(double lever, double share);
/// Of the ground on which the shipped set was made: as shipped, but for its errors.
VelocityBank::Scales velocityScalesAsShipped();
YawBank::Scales yawScalesAsShipped(double lever);

}  // namespace tread::learner
