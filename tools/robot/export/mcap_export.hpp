// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/robot/export/log_export.hpp"

namespace tread::exporting {

/// Writes an MCAP file: each channel as JSON with its JSON Schema and, if `scene` is set, the
/// drawings for Foxglove and Lichtblick (common/scene).
ExportCounts exportMcap(const std::vector<std::string>& logs, const Selection& selection,
                        const std::string& path, bool scene);

}  // namespace tread::exporting
