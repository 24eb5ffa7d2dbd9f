// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/detectable.hpp"

#include <algorithm>
#include <limits>

namespace tread::gap {

double detectableSize(const std::vector<Candidate>& candidates, const ScoreTest& test, size_t index,
                      double needed) {
  const auto sizeOf = [&](size_t i) {
    return needed * test.sizeError(static_cast<Eigen::Index>(i));
  };
  const Candidate& best = candidates[index];
  if (!parameterNamed(effectNamed(best.effect), best.parameter).reciprocal()) return sizeOf(index);
  double gentlest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& tried = candidates[i];
    // The direction goes to the limit itself: all of it must be seen.
    if (tried.effect == best.effect && tried.parameter == best.parameter &&
        sizeOf(i) <= tried.change)
      gentlest = std::min(gentlest, tried.value);
  }
  return gentlest;
}

}  // namespace tread::gap
