// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/soundness/core/log_validation.hpp"

namespace tread::gap {

/// What was sound and is not any more, or not yet: frozen, of another sign, turned.
void checkMidway(const Drive& drive, const std::vector<PoseIncrement>& increments,
                 Diagnostics& notes);

}  // namespace tread::gap
