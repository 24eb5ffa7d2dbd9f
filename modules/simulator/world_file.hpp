// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "modules/simulator/core/world.hpp"

namespace tread::sim {

/// Reads a world file (config/worlds); throws ConfigError with file:line.
WorldDescription readWorld(const std::string& path);
/// The same from text; `name` stands for the file in messages.
WorldDescription parseWorld(const std::string& text, const std::string& name);

}  // namespace tread::sim
