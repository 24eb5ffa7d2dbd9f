// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/report/limits.hpp"

#include "tools/gap/report/words.hpp"

namespace tread::gap {

PlausibleRange plausibleRange(const Finding& finding, const std::string& path) {
  for (const ParameterBounds& bounds : finding.after.bounds)
    if (bounds.parameter == path) return {bounds.min, bounds.max};
  const EffectParameter* parameter = parameterOfPath(path).parameter;
  if (parameter == nullptr) return {};
  // Of the delay and lag that the model had nothing more than all can be taken away.
  if (path == "command_delay.delay") return {-finding.after.vehicle.delay, parameter->max};
  if (path == "actuator_lag.lag") return {-finding.after.vehicle.lag, parameter->max};
  return {parameter->min, parameter->max};
}

bool isAtLimit(const Finding& finding, const Estimate& estimate) {
  const PlausibleRange range = plausibleRange(finding, estimate.parameter);
  const double near = 1e-6 * (range.max - range.min);
  return near > 0.0 && estimate.value != 0.0 &&
         (estimate.value <= range.min + near || estimate.value >= range.max - near);
}

}  // namespace tread::gap
