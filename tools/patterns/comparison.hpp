// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/pattern/pattern.hpp"

namespace tread::patterns {

/// What two sets predict of the patterns that both have, matched by name: a line a pattern with
/// both ends and their difference, and in words which differs most.
/** The difference is that of end b from end a, in the frame of the start. Patterns whose commands
 * differ are named, not compared. */
std::string comparison(const PatternSet& a, const std::string& name_a, const PatternSet& b,
                       const std::string& name_b);

}  // namespace tread::patterns
