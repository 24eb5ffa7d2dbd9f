// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "modules/pattern_recorder/recorder_node.hpp"

namespace tread::patterns {

/// Runs a pattern_recorder::RecorderNode over real LCM to its end and prints what it says; the
/// executions by pattern.
/** Throws std::runtime_error if it fails or is interrupted (SIGINT, SIGTERM, SIGHUP), after the
 * robot was told to stop; what was recorded until then is written to `part`, in a folder that is
 * there, as far as it goes. */
std::vector<std::vector<recordings::Execution>> recordLive(
    const PatternSet& set, const pattern_recorder::RecordingConfig& how, const std::string& lcm_url,
    const std::string& part);

}  // namespace tread::patterns
