// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "modules/identification/core/diagnostics.hpp"
#include "tools/gap/spans.hpp"

namespace tread::gap {

inline constexpr int64_t kOvertaking = 200'000;  ///< [us] by which messages may come out of order

/// Missing channels, messages of another type, commands of two kinds, silences, jumps and frozen
/// poses.
void checkChannels(const SortedLog& log, const std::vector<HeardSpan>& spans, Diagnostics& notes);

/// Clocks that jump or go back, pauses over which the robot did not move among them.
void checkClocks(const SortedLog& log, Diagnostics& notes);

/// Two robots (or two publishers of a channel) in one log.
void checkPublishers(const SortedLog& log, Diagnostics& notes);

}  // namespace tread::gap
