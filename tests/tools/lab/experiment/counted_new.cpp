// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// A separate file, as the compiler would warn of a mismatched free() if it saw both.
#include "tests/tools/lab/experiment/counted_new.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::size_t> count{0};
}

namespace tread::experiment::testing {
std::size_t allocations() {
  return count;
}
}  // namespace tread::experiment::testing

#ifndef TREAD_INSTRUMENTED  // sanitizers have their own
void* operator new(std::size_t size) {
  count.fetch_add(1, std::memory_order_relaxed);
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
#endif
