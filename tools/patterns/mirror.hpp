// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"

namespace tread::patterns {

/// Whether a pattern commands its tracks differently anywhere; else it is its own mirror image.
bool turns(const MotionPattern& pattern);

/// The name of the mirror image: the words left and right exchanged, else with _mirrored behind it.
std::string mirroredName(const std::string& name);

/// The pattern of the set that is this one with left and right exchanged, in its commands and in
/// the steady commands of its classes, or nullptr.
const MotionPattern* mirrorPartner(const PatternSet& set, const MotionPattern& pattern);

/// Left and right exchanged: commands, name, y, yaw and their signs in the covariance; never
/// learned. The id is the caller's to give.
MotionPattern mirrored(const MotionPattern& pattern);

/// The set with the mirror image of every pattern that turns and has no partner, or of the named
/// one only; `notes` tells what was added and what could not be.
/** Throws std::runtime_error if the named pattern is not there, has a partner, goes straight or is
 * between classes that turn and have no mirror image in the set, and if a name that is needed
 * belongs to another pattern. */
PatternSet withMirrors(const PatternSet& set, const std::optional<std::string>& only,
                       std::vector<std::string>& notes);

}  // namespace tread::patterns
