// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "modules/identification/core/finding.hpp"

namespace tread::gap {

/// Values between which a parameter is plausible; not known where the two are equal.
struct PlausibleRange {
  double min = 0.0;
  double max = 0.0;
};

/// The model file's bounds of a parameter, else the catalogue's.
PlausibleRange plausibleRange(const Finding& finding, const std::string& path);

/// Whether an estimate ran to the end of what is plausible: then it is no measurement.
bool isAtLimit(const Finding& finding, const Estimate& estimate);

}  // namespace tread::gap
