// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/robot/export/log_export.hpp"

namespace tread::exporting {

/// Writes one CSV file per channel: the time of recording by the robot's clock, one column per
/// number or text; an array of variable length is one column of JSON.
ExportCounts exportCsv(const std::vector<std::string>& logs, const Selection& selection,
                       const std::string& folder);

}  // namespace tread::exporting
