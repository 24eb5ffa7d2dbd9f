// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "tools/replay/ins_replay.hpp"

namespace tread {

/// The track of an INS log in the map, with headings; throws std::runtime_error if it cannot be
/// written.
void drawTrack(const InsReplay& replay, const std::string& title, const std::string& path);

}  // namespace tread
