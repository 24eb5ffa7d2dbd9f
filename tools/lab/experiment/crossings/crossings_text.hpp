// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/experiment/crossings/crossings.hpp"

namespace tread::experiment {

/// Numbers of runs and changes.
std::string textOf(const std::vector<CrossingDrives>& drives);
/// Errors, regions and notices as a table for people; errors and notices for programs.
std::string textOf(const std::vector<CrossingErrors>& errors);
std::string csvOf(const std::vector<CrossingErrors>& errors);
std::string noticedCsvOf(const std::vector<CrossingErrors>& errors);

}  // namespace tread::experiment
