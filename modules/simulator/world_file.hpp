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

/// The world as a file that readWorld() reads back to the same numbers. Boxes become their corners.
std::string formatWorld(const WorldDescription& world);
/// Writes formatWorld() to a file; throws std::runtime_error with one clear line if it cannot.
void writeWorld(const std::string& path, const WorldDescription& world);

}  // namespace tread::sim
