// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tools/lab/experiment/adaptation/adaptation.hpp"

namespace tread::adaptation {

/// Lines of a report that stand in one table: of what was left out, vehicle and horizon.
struct Group {
  HeldOut kind;
  std::string vehicle;
  size_t horizon;
  std::vector<std::string> rules;  ///< in the order of the report
  std::vector<const SummaryLine*> lines;

  const SummaryLine& of(const std::string& rule, size_t executions) const;
};

/// The groups in the order of the lines, which must outlive them.
std::vector<Group> groupsOf(const Report& report);

/// Ratios to no learning over executions, a line for each rule, a row of panels for each group at
/// 5 s (PNG).
void drawRatios(const std::string& path, const std::vector<Group>& groups);

}  // namespace tread::adaptation
