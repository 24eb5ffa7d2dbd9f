// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

namespace tread::testing {

/// How often a test repeats itself: all of it, or a tenth (at least once) in an instrumented build,
/// where each step is ten times as slow and a few are enough to find what is found there.
constexpr int effort(int repetitions) {
#ifdef TREAD_INSTRUMENTED
  return repetitions >= 10 ? repetitions / 10 : 1;
#else
  return repetitions;
#endif
}

}  // namespace tread::testing
