// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/report/limits.hpp"

namespace tread::gap {

PlausibleRange plausibleRange(const Finding& finding, const std::string& path) {
  const auto bounds = plausibleBounds(finding.after, path);
  return bounds ? PlausibleRange{bounds->min, bounds->max} : PlausibleRange{};
}

bool isAtLimit(const Finding& finding, const Estimate& estimate) {
  const PlausibleRange range = plausibleRange(finding, estimate.parameter);
  const double near = 1e-6 * (range.max - range.min);
  return near > 0.0 && estimate.value != 0.0 &&
         (estimate.value <= range.min + near || estimate.value >= range.max - near);
}

}  // namespace tread::gap
