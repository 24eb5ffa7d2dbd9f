// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/report/page.hpp"
#include "modules/identification/core/finding.hpp"

namespace tread::gap {

/// Headline of a report in one line, for instance "Found: Limit of turning power", or "A or B: this
/// drive cannot tell them apart".
std::string headlineOf(const GapFinding& finding);

/// The last lines that find prints, verdict first.
std::vector<std::string> closingLines(const GapFinding& finding);

/// Content of the first screen: sentences, gain, next steps.
std::vector<Block> firstBlocks(const GapFinding& finding);

/// Colour class: good, change or doubt.
std::string moodOf(GapVerdict verdict);

}  // namespace tread::gap
