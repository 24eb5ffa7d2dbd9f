// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/experiment/adaptation/groups.hpp"

namespace tread::adaptation {

/// Ratios to no learning over executions, a line per rule, a row of panels per group, 5 s ahead
/// (PNG).
void drawRatios(const std::string& path, const std::vector<Group>& groups);

}  // namespace tread::adaptation
