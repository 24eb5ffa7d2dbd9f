// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "modules/identification/core/rows.hpp"

namespace tread::gap {

/// Blocks of measured driving from which chance and cause can be told apart.
inline constexpr int kLeastBlocks = 10;

/// Blocks in which something was measured.
int measuredBlocks(const Rows& rows);

/// Empty if rows are enough to conclude anything from; else one line that says how much to drive.
std::string tooLittleDriving(const Rows& rows);

}  // namespace tread::gap
