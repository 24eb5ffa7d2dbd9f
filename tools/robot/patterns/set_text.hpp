// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"

namespace tread::patterns {

/// Tracks exchanged, steering to the other side.
Command mirroredCommand(const Command& command, const CommandChannels& channels);

/// Whether a pattern commands its tracks differently, or steers, anywhere; else it is its own
/// mirror image.
bool turns(const MotionPattern& pattern, const CommandChannels& channels);

/// The name of the mirror image: the words left and right exchanged, else with _mirrored behind it.
std::string mirroredName(const std::string& name);

/// The pattern of the set that is this one with left and right exchanged, in its commands and in
/// the steady commands of its classes, or nullptr.
const MotionPattern* mirrorPartner(const PatternSet& set, const MotionPattern& pattern);

/// Left and right exchanged: commands, name, y, yaw and their signs in the covariance; never
/// learned. The id is the caller's to give.
MotionPattern mirrored(const MotionPattern& pattern, const CommandChannels& channels);

/// The set with the mirror image of every pattern that turns and has no partner, or of the named
/// one only; `notes` tells what was added and what could not be.
/** Throws std::runtime_error if the named pattern is not there, has a partner, goes straight or is
 * between classes that turn and have no mirror image in the set, and if a name that is needed
 * belongs to another pattern. */
PatternSet withMirrors(const PatternSet& set, const std::optional<std::string>& only,
                       std::vector<std::string>& notes);

/// A set as a table for people: one line a pattern with classes, duration, length, end pose and its
/// spread.
std::string table(const PatternSet& set);

/// What two sets predict of the patterns that both have, matched by name: a line a pattern with
/// both ends and their difference, and in words which differs most.
/** The difference is that of end b from end a, in the frame of the start. Patterns whose commands
 * differ are named as well. */
std::string comparison(const PatternSet& a, const std::string& name_a, const PatternSet& b,
                       const std::string& name_b);

/// What a valid set may still make trouble with, a line each: a turn without its mirror image, a
/// class that cannot be reached from standing or left for it, a trajectory that does not end in its
/// exit class's twist, end covariances that nobody knows.
std::vector<std::string> adviceFor(const PatternSet& set);

/// A set as it stands in a picture.
struct PicturedSet {
  std::string label;
  PatternSet set;
};

/// Draws all trajectories of one or two sets, a panel for each entry class: paths, headings at
/// their ends, and the ellipse that holds 95 % of the end positions. Throws std::runtime_error if
/// the PNG cannot be written.
void drawSets(const std::vector<PicturedSet>& sets, const std::string& path);

}  // namespace tread::patterns
