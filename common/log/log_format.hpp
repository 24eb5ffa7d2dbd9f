// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <cstdint>

namespace tread {

// An LCM event log is a row of events: sync word, event number (64 bits), utime (64), length of the
// channel's name (32), length of the message (32), name, message; all big-endian.
inline constexpr uint32_t kLogSync = 0xEDA1DA01;
inline constexpr size_t kLogHeaderSize = 28;  // [bytes]
/// LCM's longest channel name.
inline constexpr uint32_t kLongestChannel = 63;

/// Writes a big-endian number of `Size` bytes.
template <size_t Size>
void putBigEndian(uint8_t* at, uint64_t value) {
  for (size_t i = 0; i < Size; ++i) at[i] = static_cast<uint8_t>(value >> (8 * (Size - 1 - i)));
}

/// Reads a big-endian number of `Size` bytes.
template <size_t Size>
uint64_t getBigEndian(const uint8_t* at) {
  uint64_t value = 0;
  for (size_t i = 0; i < Size; ++i) value = (value << 8) | at[i];
  return value;
}

}  // namespace tread
