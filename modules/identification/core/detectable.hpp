// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "modules/identification/core/candidates.hpp"
#include "modules/identification/core/score_test.hpp"

namespace tread::gap {

/// The smallest size of a candidate's effect that would have been seen, in its parameter's unit.
/** `needed`: score from which on an effect is seen, with the power that is wanted. A limit bites or
 * does not, and has no size that shrinks: of a limit it is the gentlest one among the candidates
 * that would have been seen. Infinite where nothing would. */
double detectableSize(const std::vector<Candidate>& candidates, const ScoreTest& test, size_t index,
                      double needed);

}  // namespace tread::gap
