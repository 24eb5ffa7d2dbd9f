// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/soundness/reading.hpp"

namespace tread::gap {

/// Checks for an offset between the clocks of commands and poses, and its size.
void checkOffset(const SortedLog& log, const std::vector<HeardSpan>& spans, Diagnostics& notes);

}  // namespace tread::gap
