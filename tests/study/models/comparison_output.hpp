// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/report/page.hpp"
#include "tests/study/models/model_comparison.hpp"

namespace tread::gap {

using report::Page;

/// A comparison and its input files.
struct ComparisonReport {
  ModelComparison comparison;
  std::string model;                ///< file name of the ideal model; empty = one per recording
  std::vector<std::string> sha256;  ///< of the logs
};

/// Tables of errors and of the named effects.
Page comparisonPage(const ComparisonReport& report);

/// The same tables padded with spaces, for a terminal.
std::string comparisonText(const ComparisonReport& report);

/// Content of comparison.json; numbers that are not finite become null.
/** Keys: tool, seed, model, nested and pooled [{log, sha256, blocks, driven_s, remark,
 * structure_nested, rungs {name: {executions, yaw_rad, position_m: {median, rms}}}, floor,
 * discovered_less {rung: {yaw_rad, position_m: {mean, error}}}, folds [{trained_on,
 * named {rung: [effect]}, at_end_of_range {rung: [path]}, fitted {rung: {path: value}}}]}]. */
nlohmann::ordered_json comparisonJson(const ComparisonReport& report);

/// Writes comparison.md and, last, comparison.json; throws std::runtime_error with one line.
void writeComparison(const std::string& folder, const ComparisonReport& report);

}  // namespace tread::gap
