// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/report/chart.hpp"
#include "modules/identification/core/finding.hpp"

namespace tread::gap {

using report::Chart, report::ChartPoint, report::ChartRange;

/// A residual over a variable, before and after, with 95 % intervals; filled dots are marked cells.
std::string atlasPicture(const AtlasCurve& curve);

/// The largest |mean| of a map before and after: equal colours need a common scale.
double largestResidual(const AtlasMap& map);

/// A residual over speed and yaw rate.
std::string mapPicture(const AtlasMap& map, bool after, double full_colour);

/// A driven path seen from above, ahead is up, with its heading where it ends.
void drawPath(Chart& chart, const std::vector<Pose2>& poses, const char* colour, bool dashed);

/// The part of the ground that paths need, with equal scales.
ChartRange rangeOf(const std::vector<const std::vector<Pose2>*>& paths);

/// One execution: measured, old and new model, seen from its beginning.
std::string overlayPicture(const Overlay& overlay, const std::string& title);

/// The error from which on places have their full colour: 19 of 20 are below it [m].
double fullColourOf(const std::vector<PlaceError>& places);

/// End errors where they were made, in the frame of the log.
std::string placePicture(const std::vector<PlaceError>& places, bool after, double full_colour,
                         const std::string& log);

/// What each step of the search brought on blocks that were not fitted, with its standard error.
std::string stepsPicture(const std::vector<SearchStep>& ladder);

/// Median end errors before, after and the floor.
std::string gapPicture(const Gap& gap, bool yaw);

}  // namespace tread::gap
