// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/robot/import/csv_mapping.hpp"

namespace tread::import {

/// Throws RecordingError where the units below a table's header are not the mapping's, and where a
/// spreadsheet has taken the last digits away: times must be finer than rows are apart, positions
/// than 1 m.
void checkTable(const recordings::CsvTable& table, const CsvSource& source);

}  // namespace tread::import
