// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/report/page.hpp"
#include "modules/identification/core/finding.hpp"

namespace tread::gap {

using report::Block, report::Paragraph, report::Pictures, report::Points;

/// The headline of a report in one line, for instance "Found: Limit of turning power"; where the
/// drive cannot tell, "A or B: this drive cannot tell them apart".
std::string headlineOf(const Finding& finding);

/// What find prints at its end, the verdict first.
std::vector<std::string> closingLines(const Finding& finding);

/// What stands on the first screen: sentences, gain, what to do next.
std::vector<Block> firstBlocks(const Finding& finding);

/// good, change or doubt.
std::string moodOf(GapVerdict verdict);

}  // namespace tread::gap
