// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/report/page.hpp"
#include "modules/identification/core/finding.hpp"

/// The sections of a report behind its first screen; a section without blocks is left out.
namespace tread::gap {

using report::Block, report::Commands, report::Page, report::Paragraph, report::Pictures;
using report::Points, report::Section, report::Table;

/// The headline of a report in one line, for instance "Found: Limit of turning power"; where the
/// drive cannot tell, "A or B: this drive cannot tell them apart".
std::string headlineOf(const Finding& finding);

/// What find prints at its end, the verdict first.
std::vector<std::string> closingLines(const Finding& finding);

/// What stands on the first screen: sentences, gain, what to do next.
std::vector<Block> firstBlocks(const Finding& finding);

/// good, change or doubt.
std::string moodOf(GapVerdict verdict);

/// A file that `tread-gap find` has read.
struct InputFile {
  enum class Role { kModel, kTrain, kTest };
  Role role = Role::kTrain;
  std::string name;    ///< without its folder
  std::string sha256;  ///< 64 hexadecimal digits
};

/// Those that show where and how well the model holds.
std::vector<Section> evidenceSections(const Finding& finding, const std::vector<InputFile>& inputs);

/// Name and version of this tool, for provenance.
const char* toolVersion();

/// The whole report.
Page reportPage(const Finding& finding, const std::vector<InputFile>& inputs);

}  // namespace tread::gap
