// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

namespace tread::sim {

/// One direction of a serial line: bytes arrive one after the other at the line's speed.
class SerialLine {
 public:
  /// 10 bits a byte: 8N1.
  explicit SerialLine(int baud) : byte_ns_(10'000'000'000LL / baud) {}

  /// Puts bytes on the line at a time [us].
  void send(std::string_view bytes, int64_t utime) {
    for (char byte : bytes) {
      const int64_t start = std::max(free_ns_, utime * 1000);
      free_ns_ = start + byte_ns_;
      bytes_.push_back({byte, (free_ns_ + 999) / 1000});
    }
  }

  struct Byte {
    char value;
    int64_t utime;  ///< when its stop bit has passed
  };

  /// True if a byte has arrived by a time; then front() is the first of them.
  bool arrived(int64_t utime) const { return !bytes_.empty() && bytes_.front().utime <= utime; }
  const Byte& front() const { return bytes_.front(); }
  void pop() { bytes_.pop_front(); }

  /// All bytes that have arrived by a time.
  std::string takeArrived(int64_t utime) {
    std::string out;
    for (; arrived(utime); pop()) out += front().value;
    return out;
  }

  /// Drops what is on its way.
  void clear() { bytes_.clear(); }

 private:
  int64_t byte_ns_;
  int64_t free_ns_ = 0;  ///< when the last byte has passed
  std::deque<Byte> bytes_;
};

}  // namespace tread::sim
