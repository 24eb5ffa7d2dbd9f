// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/soundness/reading.hpp"

namespace tread::gap {

/// Source of the sequence numbers in a log.
enum class Numbering {
  kByRobot,   ///< gaps show messages lost by the recorder
  kByImport,  ///< they number the recorded messages only
};

/// Checks for clocks that jump or go back, also during pauses in which the robot did not move.
void checkClocks(const SortedLog& log, Numbering numbering, Diagnostics& notes);

}  // namespace tread::gap
