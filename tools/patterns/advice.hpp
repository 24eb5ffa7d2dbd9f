// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"

namespace tread::patterns {

/// What a valid set may still make trouble with, a line each: a turn without its mirror image, a
/// class that cannot be reached from standing or left for it, a trajectory that does not end in its
/// exit class's twist, end covariances that nobody knows.
std::vector<std::string> adviceFor(const PatternSet& set);

}  // namespace tread::patterns
