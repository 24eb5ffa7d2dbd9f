// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/report/page.hpp"
#include "tests/study/models/ladder.hpp"

namespace tread::gap {

using report::Page;

/// A ladder and the files that it was made from.
struct LadderReport {
  Ladder ladder;
  std::string model;                ///< file name of the ideal model; empty = of each recording
  std::vector<std::string> sha256;  ///< of the logs
};

/// Tables of errors and of the effects that were named.
Page ladderPage(const LadderReport& report);

/// The same tables with columns of spaces, for a terminal.
std::string ladderText(const LadderReport& report);

/// What ladder.json holds; numbers that are not finite are null.
/** Keys: tool, seed, model, nested and pooled [{log, sha256, blocks, driven_s, remark,
 * structure_nested, rungs {name: {executions, yaw_rad, position_m: {median, rms}}}, floor,
 * discovered_less {rung: {yaw_rad, position_m: {mean, error}}}, folds [{trained_on, effects,
 * fitted {rung: {path: value}}}]}]. */
nlohmann::ordered_json ladderJson(const LadderReport& report);

/// Writes ladder.md and, last, ladder.json; throws std::runtime_error with one line.
void writeLadder(const std::string& folder, const LadderReport& report);

}  // namespace tread::gap
