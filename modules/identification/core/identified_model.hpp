// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"
#include "modules/identification/core/search.hpp"

namespace tread::gap {

/// The result of a search as a model: effects and terms with their 95 % intervals, covariance and
/// envelope, and the effects that the drive could not have shown.
/** `before` is the model at the start of the search. */
IdentifiedModel identifiedModel(const Fitter& fitter, const ModelDocument& before,
                                const SearchSettings& settings, const FoundTerms& result);

}  // namespace tread::gap
