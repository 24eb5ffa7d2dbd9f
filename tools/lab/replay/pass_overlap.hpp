// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>

#include "tools/lab/replay/sensor_replay.hpp"

namespace tread {

/// How obstacles of two passes over the same ground lie beside each other.
struct PassPairs {
  int pairs = 0;           ///< of passes that see common ground
  int64_t cells = 0;       ///< obstacle cells of one pass where the other one knows the ground, or
                           ///< a wall within ten cells
  int64_t within_two = 0;  ///< of these: an obstacle of the other pass lies within two cells
  int64_t within_ten = 0;  ///< of these: within ten; farther: only one pass saw it at all
};

/// Whether a recording's map closes where the robot came past again.
/** A pass is a piece of the way that mapping saw alone: 30 m, or an eighth of a shorter way. What
 * passes in a row lack has other reasons than drift: what moved, what is seen from one side only,
 * leaves. */
struct PassOverlap {
  int passes = 0;
  PassPairs in_a_row;
  PassPairs again;  ///< passes with others between them
};

/// Cuts a recording into passes, maps each alone and compares them.
PassOverlap overlapOf(const MappingRecording& recording);

/// Two lines of text.
std::string reportOf(const PassOverlap& overlap);

}  // namespace tread
