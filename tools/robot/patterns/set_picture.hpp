// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"

namespace tread::patterns {

/// A set in a picture.
struct PicturedSet {
  std::string label;
  PatternSet set;
};

/// Draws all trajectories of one or two sets, a panel for each entry class: paths, headings at
/// their ends, and the ellipse that holds 95 % of the end positions. Throws std::runtime_error if
/// the PNG cannot be written.
void drawSets(const std::vector<PicturedSet>& sets, const std::string& path);

}  // namespace tread::patterns
