// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/gap/report/report.hpp"

namespace tread::gap {

/// A residual over a variable, before and after, with 95 % intervals; filled dots are marked cells.
std::string atlasPicture(const AtlasCurve& curve);

/// The curve of an unnamed term with its 95 % band, over the data.
std::string termPicture(const UnnamedTerm& term, const UnnamedFinding& found);

/// Pictures of the largest unexplained residuals; none if all is explained.
report::Pictures restPictures(const GapFinding& finding);

/// Largest |mean| of a map before and after, for a common colour scale.
double largestResidual(const AtlasMap& map);

/// A residual over speed and yaw rate.
std::string mapPicture(const AtlasMap& map, bool after, double full_colour);

/// Draws a path seen from above, ahead is up, with the heading at its end.
void drawPath(Chart& chart, const std::vector<Pose2>& poses, const char* colour, bool dashed);

/// Common range of paths, with equal scales.
ChartRange rangeOf(const std::vector<const std::vector<Pose2>*>& paths);

/// One execution: measured, old and new model, relative to its start.
std::string overlayPicture(const Overlay& overlay, const std::string& title);

/// Error at which the colour scale saturates [m]: the 95 % quantile.
double fullColourOf(const std::vector<PlaceError>& places);

/// End errors at their position in the log's frame.
std::string placePicture(const std::vector<PlaceError>& places, bool after, double full_colour,
                         const std::string& log);

/// Gain of each search step on held-out blocks, with its standard error.
std::string stepsPicture(const std::vector<SearchStep>& ladder);

/// Median end errors before, after and the floor.
std::string gapPicture(const Gap& gap, bool yaw);

/// Sections that show where and how well the model holds.
std::vector<Section> evidenceSections(const GapFinding& finding,
                                      const std::vector<InputFile>& inputs);

}  // namespace tread::gap
