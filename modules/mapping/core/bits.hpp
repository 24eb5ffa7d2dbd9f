// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>

namespace tread::mapping {

/// Index of the lowest bit that is set; some must be.
inline int lowestBit(uint64_t bits) {
  return __builtin_ctzll(bits);
}

}  // namespace tread::mapping
