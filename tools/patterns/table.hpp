// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/pattern/pattern.hpp"

namespace tread::patterns {

/// A set as a table for people: one line a pattern with classes, duration, length, end pose and its
/// spread.
std::string table(const PatternSet& set);

}  // namespace tread::patterns
