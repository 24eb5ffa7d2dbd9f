// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/identification/core/search.hpp"

namespace tread::gap {

/// Puts one effect in the place of two where it explains as much.
/** Search goes step by step and may reach what one effect does by two others: a scale of positions
 * is slip and track width together. Only effects whose signature the found ones can imitate are
 * tried; the pair goes if it is not better on blocks left out by more than a standard error. */
void replacePairs(const Fitter& fitter, const std::vector<char>& mask, SearchResult& result,
                  const Progress& say);

}  // namespace tread::gap
