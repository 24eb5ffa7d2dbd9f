// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "modules/identification/core/search.hpp"

namespace tread::gap {

/// The model that a search ended with: its effects and terms with their 95 % intervals, covariance
/// and envelope, and the effects that the drive could not have shown.
/** `before` is the model that the search began with. */
IdentifiedModel identifiedModel(const Fitter& fitter, const ModelDocument& before,
                                const std::vector<char>& mask, const SearchSettings& settings,
                                const SearchResult& result);

}  // namespace tread::gap
