// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "tools/robot/import/csv_mapping.hpp"
#include "tools/robot/import/foreign_drive.hpp"

namespace tread::import {

/// Reads a recording in CSV: one file, or a folder of several, as described by the mapping.
/** Time 0 is the earliest row. Empty fields and "nan" are no measurements and are counted. If the
 * heading is the course over ground, poses at low speed and of turns on the spot are dropped and
 * counted. Throws RecordingError with one line that names file, line and column. */
ForeignDrive readMappedCsv(const std::string& path, const CsvMapping& mapping);

}  // namespace tread::import
