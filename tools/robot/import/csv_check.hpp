// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/robot/import/csv_mapping.hpp"

namespace tread::import {

/// Throws RecordingError if the unit row below a table's header contradicts the mapping, or if a
/// spreadsheet has rounded the values: times need a resolution below the row period, positions
/// below 1 m.
void checkTable(const recordings::CsvTable& table, const CsvSource& source);

}  // namespace tread::import
