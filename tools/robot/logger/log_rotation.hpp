// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

namespace tread::launch {

/// Moves FILE.0 to FILE.1, FILE.1 to FILE.2 and so on, up to the first gap, so that FILE.0 is free;
/// what would become FILE.<keep> is removed. Throws std::filesystem::filesystem_error.
void makeRoomForLog(const std::string& file, int keep);

}  // namespace tread::launch
