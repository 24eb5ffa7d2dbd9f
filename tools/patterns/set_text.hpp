// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"

namespace tread::patterns {

/// A set as a table for people: one line a pattern with classes, duration, length, end pose and its
/// spread.
std::string table(const PatternSet& set);

/// What two sets predict of the patterns that both have, matched by name: a line a pattern with
/// both ends and their difference, and in words which differs most.
/** The difference is that of end b from end a, in the frame of the start. Patterns whose commands
 * differ are named, not compared. */
std::string comparison(const PatternSet& a, const std::string& name_a, const PatternSet& b,
                       const std::string& name_b);

/// What a valid set may still make trouble with, a line each: a turn without its mirror image, a
/// class that cannot be reached from standing or left for it, a trajectory that does not end in its
/// exit class's twist, end covariances that nobody knows.
std::vector<std::string> adviceFor(const PatternSet& set);

}  // namespace tread::patterns
