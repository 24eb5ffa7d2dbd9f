// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace tread::fuzz {

/// Reads bytes as one reader would; throws or crashes only where that reader must not.
using Target = void (*)(const uint8_t* bytes, size_t size);

/// Every decoder and reader by its name.
const std::map<std::string, Target>& targets();

/// Those of the tools, which are there where tools are built.
void addToolTargets(std::map<std::string, Target>& all);

/// Those of the range finders' protocols.
void addRangeFinderTargets(std::map<std::string, Target>& targets);

}  // namespace tread::fuzz
