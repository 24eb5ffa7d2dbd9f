// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"

namespace tread::patterns {

/// Tracks exchanged, steering reversed.
Command mirroredCommand(const Command& command, const CommandChannels& channels);

/// Whether a pattern turns: its tracks differ somewhere, or it steers. Otherwise it is its own
/// mirror image.
bool turns(const MotionPattern& pattern, const CommandChannels& channels);

/// Name of the mirror image: the words left and right exchanged, else the suffix _mirrored.
std::string mirroredName(const std::string& name);

/// The set's mirror image of this pattern, in its commands and in the steady commands of its
/// classes, or nullptr.
const MotionPattern* mirrorPartner(const PatternSet& set, const MotionPattern& pattern);

/// Exchanges left and right: commands, name, y, yaw and their signs in the covariance. The result
/// counts as never learned; the caller sets the id.
MotionPattern mirrored(const MotionPattern& pattern, const CommandChannels& channels);

/// Adds the mirror image of every pattern that turns and has none, or only of the named one;
/// `notes` lists what was added and what could not be.
/** Throws std::runtime_error if the named pattern does not exist, has a mirror image, goes straight
 * or connects turning classes that have no mirror image, or if the new name is already in use. */
PatternSet withMirrors(const PatternSet& set, const std::optional<std::string>& only,
                       std::vector<std::string>& notes);

/// A table for people: per pattern its classes, duration, length, end pose and spread.
std::string table(const PatternSet& set);

/// Compares the predictions of two sets for patterns of the same name: per pattern both ends and
/// their difference, and in words the largest difference.
/** The difference is that of end b from end a, in the frame of the start. Also lists patterns with
 * different commands. */
std::string comparison(const PatternSet& a, const std::string& name_a, const PatternSet& b,
                       const std::string& name_b);

/// Warnings about a valid set, one per line: a turn without its mirror image, a class that cannot
/// be reached from or left to standstill, a trajectory that does not end in its exit class's twist,
/// unknown end covariances.
std::vector<std::string> adviceFor(const PatternSet& set);

}  // namespace tread::patterns
