// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <cstdint>

namespace tread {

/// Times are whole microseconds; models and limits are in seconds.
inline int64_t toMicroseconds(double seconds) {
  return std::llround(1e6 * seconds);
}

}  // namespace tread
