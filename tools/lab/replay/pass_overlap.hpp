// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>

#include "tools/lab/replay/ins_replay.hpp"
#include "tools/lab/replay/mapping_replay.hpp"

namespace tread {

/// Agreement of the obstacles of two passes over the same ground.
struct PassPairs {
  int pairs = 0;  ///< of passes with common ground
  /// obstacle cells of one pass where the other one knows the ground, or has a wall within ten
  /// cells
  int64_t cells = 0;
  int64_t within_two = 0;  ///< of these with an obstacle of the other pass within two cells
  int64_t within_ten = 0;  ///< of these within ten; the others were seen by one pass only
};

/// Whether a recording's map is consistent where the robot passed again.
/** A pass is a section of the path mapped on its own: 30 m, or an eighth of a shorter path.
 * Differences between consecutive passes have other causes than drift: moving objects, views from
 * one side only, leaves. */
struct PassOverlap {
  int passes = 0;
  PassPairs in_a_row;
  PassPairs again;  ///< passes with others in between
};

/// Cuts a recording into passes, maps each separately and compares them.
PassOverlap overlapOf(const MappingRecording& recording);

/// Two lines of text.
std::string reportOf(const PassOverlap& overlap);

}  // namespace tread
