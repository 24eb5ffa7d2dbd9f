// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/experiment/tables.hpp"

namespace tread::experiment {

/// Medians and worst cases by rule: reductions, all patterns, unchanged ground; for several sets of
/// recordings means and standard deviations.
std::string textOfKeyFigures(const Tables& tables, const Setting& setting,
                             const std::vector<Tables>& sets);

}  // namespace tread::experiment
