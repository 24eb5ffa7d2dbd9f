// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

namespace tread {

/// The folder of robots, patterns, models and launch files that are shipped with this program.
/** Next to the program's folder, both in a build and after cmake --install; /etc/tread for Debian
 * packages. If neither exists, the first is returned: opening a file in it fails with its name. */
std::string shippedConfig();

}  // namespace tread
