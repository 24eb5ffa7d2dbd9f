// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tread::ins {

/// Why a sentence was not used.
enum class Refusal : uint8_t {
  kCut,              ///< a new '$' came before the end of the line
  kNotPrintable,     ///< a byte that NMEA 0183 does not allow in a sentence
  kTooLong,          ///< no line end within the length limit
  kNoChecksum,       ///< the line does not end in '*' and two hexadecimal digits
  kWrongChecksum,    ///< the digits are not the exclusive-or of the sentence
  kUnknownSentence,  ///< well-formed, but not one of ours
  kFieldCount,       ///< more or fewer fields than this sentence has
  kBadField,         ///< a field that is not empty and not of its form
  kOutOfRange,       ///< a number or date that cannot be
  kLate,             ///< its epoch has already been published
  kCount
};

inline constexpr size_t kRefusalCount = static_cast<size_t>(Refusal::kCount);

/// The reason in words, as counters and reports print it.
constexpr const char* name(Refusal reason) {
  constexpr const char* kNames[kRefusalCount] = {
      "cut short",        "not printable", "too long",  "no checksum",  "wrong checksum",
      "unknown sentence", "field count",   "bad field", "out of range", "late"};
  return reason < Refusal::kCount ? kNames[static_cast<size_t>(reason)] : "?";
}

/// How often each reason applied.
struct RefusalCounts {
  std::array<int64_t, kRefusalCount> of{};

  void add(Refusal reason) { ++of[static_cast<size_t>(reason)]; }
  int64_t operator[](Refusal reason) const { return of[static_cast<size_t>(reason)]; }

  int64_t total() const {
    int64_t sum = 0;
    for (const int64_t count : of) sum += count;
    return sum;
  }
};

}  // namespace tread::ins
