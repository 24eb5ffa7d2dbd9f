// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "tools/replay/mapping_replay.hpp"

namespace tread {

/// The map with the track in it; throws std::runtime_error if it cannot be written.
void drawMap(const MappingReplay& replay, const std::string& path);

}  // namespace tread
