// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/soundness/core/log_validation.hpp"

namespace tread::gap {

/// Signals that are valid in one part of the drive only: frozen, inverted or turned in the other.
void checkMidway(const Drive& drive, const std::vector<PoseIncrement>& increments,
                 Diagnostics& notes);

}  // namespace tread::gap
