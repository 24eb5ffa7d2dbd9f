// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/report/chart.hpp"
#include "common/report/page.hpp"
#include "common/report/text.hpp"
#include "common/vehicle/effects.hpp"
#include "modules/identification/core/finding.hpp"

// Text and pictures of a report: the first screen, the sections after it (empty ones are omitted),
// and the explanations for reading and using it.
namespace tread::gap {

/// Whether a drive does not decide between the two.
inline bool isAsGood(const RunnerUp& runner_up) {
  return runner_up.behind < runner_up.error;
}

using report::Chart, report::ChartPoint, report::ChartRange;

using report::Block, report::Commands, report::Page, report::Paragraph, report::Pictures;
using report::Points, report::Section, report::Table;

/// An input file of `tread-gap find`.
struct InputFile {
  enum class Role { kModel, kTrain, kTest };
  Role role = Role::kTrain;
  std::string name;    ///< without its folder
  std::string sha256;  ///< 64 hexadecimal digits
};

}  // namespace tread::gap
