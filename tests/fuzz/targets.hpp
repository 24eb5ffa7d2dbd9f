// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace tread::fuzz {

/// Feeds bytes to one reader; throws or crashes only on a violated promise.
using Target = void (*)(const uint8_t* bytes, size_t size);

/// Every decoder and reader by its name.
const std::map<std::string, Target>& targets();

/// The tools' targets, in builds with tools.
void addToolTargets(std::map<std::string, Target>& all);

/// Those of the range finders' protocols.
void addRangeFinderTargets(std::map<std::string, Target>& targets);

}  // namespace tread::fuzz
