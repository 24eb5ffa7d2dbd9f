// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <random>

namespace tread::experiment {

/// One of `count` things, drawn by chance; the same on every machine.
inline size_t drawIndex(std::mt19937_64& random, size_t count) {
  return static_cast<size_t>(((random() >> 32) * static_cast<uint64_t>(count)) >> 32);
}

/// A seed of its own for each combination of numbers (splitmix64 over all of them).
inline uint64_t seedOf(std::initializer_list<uint64_t> numbers) {
  uint64_t state = 0;
  for (const uint64_t number : numbers) {
    state += number + 0x9E3779B97F4A7C15ULL;
    state = (state ^ (state >> 30)) * 0xBF58476D1CE4E5B9ULL;
    state = (state ^ (state >> 27)) * 0x94D049BB133111EBULL;
    state ^= state >> 31;
  }
  return state;
}

}  // namespace tread::experiment
