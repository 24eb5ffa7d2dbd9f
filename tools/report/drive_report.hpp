// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "modules/simulator/core/world.hpp"
#include "modules/simulator/truth_record.hpp"
#include "tools/report/drive_record.hpp"
#include "tools/report/rule_errors.hpp"

namespace tread::report {

/// What only a simulation knows of a drive.
struct SimulationTruth {
  std::optional<sim::WorldDescription> world;
  std::vector<sim::TruthRow> rows;  ///< empty = no record
};

/// The drive in words: one line of result first, then errors, as driven and by rule, and latencies.
std::string wordsOf(const DriveRecord& drive, const SimulationTruth& truth,
                    const RuleErrors& by_rule);
/// The one line of result alone.
std::string resultLine(const DriveRecord& drive, const SimulationTruth& truth);
/// The drive to be drawn.
report::DriveScene sceneOf(const DriveRecord& drive, const SimulationTruth& truth,
                           const RuleErrors& by_rule);

}  // namespace tread::report
