// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>

namespace tread::experiment::testing {

/// Allocations of this program so far, of all threads; 0 in an instrumented build.
std::size_t allocations();

}  // namespace tread::experiment::testing
