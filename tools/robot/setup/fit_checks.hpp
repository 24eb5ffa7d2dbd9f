// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/robot/setup/setup.hpp"

namespace tread::setup {

/// Compares footprint, ranges, stopping distance, rates and leases with each other.
std::vector<FitCheck> checkFit(const SetupResult& result);

}  // namespace tread::setup
