// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

namespace tread {

/// The folder of robots, patterns, models and launch files that came with this program.
/** Beside the folder of the program, in a build as after cmake --install; of Debian's packages
 * /etc/tread. Where neither exists it is the first: opening a file in it fails and names it. */
std::string shippedConfig();

}  // namespace tread
