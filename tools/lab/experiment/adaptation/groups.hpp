// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tools/lab/experiment/adaptation/adaptation_report.hpp"

namespace tread::adaptation {

/// Lines of a report in the same table: same omission, vehicle and horizon.
struct Group {
  HeldOut kind;
  std::string vehicle;
  size_t horizon;
  std::vector<std::string> rules;  ///< in the order of the report
  std::vector<const SummaryLine*> lines;

  const SummaryLine& of(const std::string& rule, size_t executions) const;
};

/// Groups in the order of the lines, which must outlive them.
std::vector<Group> groupsOf(const Report& report);

}  // namespace tread::adaptation
