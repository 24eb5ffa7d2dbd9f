// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "modules/identification/core/search.hpp"

namespace tread::gap {

/// Rows of every other block: those of `half` (0 or 1) count.
std::vector<char> halfMask(const Observations& data, int half);

/// Takes the effects that were not accepted out of a result unless the end error falls with them,
/// by more than its standard error over blocks, on halves of the driving that the sizes of the
/// effects were not fitted to.
/** Effects of the INS, which may move no pose, may lessen what is left of the yaw rate instead. */
void dropUnconfirmed(const Fitter& fitter, const std::vector<char>& mask,
                     const SearchSettings& settings, SearchResult& result, const Progress& say);

}  // namespace tread::gap
