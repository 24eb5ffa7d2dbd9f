// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/experiment/adaptation/adaptation.hpp"

namespace tread::adaptation {

/// Mean and interval of one number per session; no interval for a single session.
ConfidenceInterval intervalOf(const std::vector<double>& values, uint64_t seed);

const char* nameOf(Verdict verdict);

/// All lines, ordered by kind of omission, vehicle, horizon, rule, executions.
std::vector<SummaryLine> summaryOf(const AdaptationErrors& errors,
                                   const std::vector<std::string>& rules, uint64_t seed);

}  // namespace tread::adaptation
