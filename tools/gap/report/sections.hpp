// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/report/page.hpp"
#include "modules/identification/core/finding.hpp"

/// The sections of a report behind its first screen; a section without blocks is left out.
namespace tread::gap {

/// A file that `tread-gap find` has read.
struct InputFile {
  enum class Role { kModel, kTrain, kTest };
  Role role = Role::kTrain;
  std::string name;    ///< without its folder
  std::string sha256;  ///< 64 hexadecimal digits
};

using report::Block, report::Commands, report::Page, report::Paragraph, report::Pictures;
using report::Points, report::Section, report::Table;

Section effectsSection(const Finding& finding);
Section atlasSection(const Finding& finding);
Section executionsSection(const Finding& finding, const std::vector<InputFile>& inputs);
Section placesSection(const Finding& finding, const std::vector<InputFile>& inputs);
Section stepsSection(const Finding& finding);
Section parametersSection(const Finding& finding);
Section alternativesSection(const Finding& finding);
Section notShownSection(const Finding& finding);
Section decisionsSection(const Finding& finding);
Section envelopeSection(const Finding& finding);
Section logsSection(const Finding& finding);
Section candidatesSection(const Finding& finding);
Section wordsSection();
Section filesSection(const Finding& finding, const std::vector<InputFile>& inputs);

/// Name and version of this tool, for provenance.
const char* toolVersion();

/// The whole report.
Page reportPage(const Finding& finding, const std::vector<InputFile>& inputs);

}  // namespace tread::gap
