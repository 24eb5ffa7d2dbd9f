// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/soundness/reading.hpp"

namespace tread::gap {

/// Who gave the messages of a log their numbers.
enum class Numbering {
  kByRobot,   ///< a message that the recorder lost is missing in them
  kByImport,  ///< they count what the recording has
};

/// Clocks that jump or go back, pauses over which the robot did not move among them.
void checkClocks(const SortedLog& log, Numbering numbering, Diagnostics& notes);

}  // namespace tread::gap
