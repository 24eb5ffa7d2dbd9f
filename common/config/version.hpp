// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

namespace tread {

/// "0.1.0", as in the top CMakeLists.txt.
const char* version();

/// The commit that this was built from, "59f8ce72a1b2", with "-dirty" for modified files; empty if
/// neither git nor the archive provides it.
const char* commit();

}  // namespace tread
