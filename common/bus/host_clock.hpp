// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <chrono>
#include <cstdint>

namespace tread {

/// Present CLOCK_MONOTONIC of this host [us], the robot's clock; for buses and for stamping device
/// data.
inline int64_t hostNow() {
  using std::chrono::duration_cast;
  using std::chrono::microseconds;
  // steady_clock is CLOCK_MONOTONIC on Linux.
  return duration_cast<microseconds>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Present UTC of this host [us since 1970]; only to date logs.
inline int64_t hostUtc() {
  using std::chrono::duration_cast;
  using std::chrono::microseconds;
  return duration_cast<microseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace tread
