// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/replay/sensor_replay.hpp"

namespace tread {

/// Reads a recording: *.gz and *.clf as CARMEN text with corrected poses (FLASER lines), other
/// names as the LCM log of an MBot (2017).
/** Throws std::runtime_error with one clear line if it cannot be read or contains no scan. */
MappingRecording readMappingRecording(const std::string& path);

}  // namespace tread
