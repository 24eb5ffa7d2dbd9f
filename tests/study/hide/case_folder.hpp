// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "tests/study/hide/blind_case.hpp"

namespace tread::blind {

/// Writes blind/NAME.lcm for tread-gap and truth/NAME.json for the scores.
/** The truth is written first. Throws std::runtime_error with one clear line if a file cannot be
 * written or exists. */
void writeCase(const std::string& folder, const std::string& name, const MadeCase& made);

}  // namespace tread::blind
