// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/scan_matching/core/registration.hpp"

namespace tread::scan_matching {

/// The pose with most returns on points of the map, within a window around the prior of 2.5
/// standard deviations, at most 1.5 m and 0.6 rad.
/** Source: Olson 2009, correlative scan matching, in two resolutions. */
Pose2 searchPose(const std::vector<ScanPoint>& points, const LocalMap& map, const PosePrior& prior);

}  // namespace tread::scan_matching
