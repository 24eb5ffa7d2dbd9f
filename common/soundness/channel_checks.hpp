// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/soundness/reading.hpp"

namespace tread::gap {

/// Checks for missing channels, commands of two kinds, silences, jumps and frozen poses.
void checkChannels(const SortedLog& log, const std::vector<HeardSpan>& spans, Diagnostics& notes);

/// Checks for two robots (or two publishers of a channel) in one log.
void checkPublishers(const SortedLog& log, Diagnostics& notes);

}  // namespace tread::gap
