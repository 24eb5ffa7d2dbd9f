// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/gap/report/report.hpp"

namespace tread::gap {

/// Name and version of this program, for provenance.
std::string toolVersion();

/// The whole report.
Page reportPage(const GapFinding& finding, const std::vector<InputFile>& inputs);

}  // namespace tread::gap
