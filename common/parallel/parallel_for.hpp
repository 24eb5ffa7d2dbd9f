// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <functional>

namespace tread {

/// Runs body(0) .. body(count - 1), possibly at the same time; results must not depend on the
/// order.
using ParallelFor = std::function<void(size_t count, const std::function<void(size_t)>& body)>;

/// One after the other.
inline void serialFor(size_t count, const std::function<void(size_t)>& body) {
  for (size_t i = 0; i < count; ++i) body(i);
}

/// On this many threads, including the caller's, or fewer if the system does not allow more.
/** After a call throws, no further call starts; once the running ones have ended, the first
 * exception is rethrown to the caller. */
ParallelFor onThreads(int threads);

}  // namespace tread
