// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <unistd.h>

#include <chrono>
#include <string>

#include "common/link/link.hpp"

namespace tread::testing {

inline bool send(Link& link, const std::string& text) {
  return link.write(reinterpret_cast<const uint8_t*>(text.data()), text.size());
}

/// Reads until `size` bytes arrived, the link closed, or 1 s passed.
inline std::string receive(Link& link, size_t size) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(1);
  std::string text;
  while (text.size() < size && std::chrono::steady_clock::now() < deadline) {
    uint8_t buffer[4096];
    const auto count = link.read(buffer, sizeof buffer);
    if (!count) break;
    text.append(reinterpret_cast<const char*>(buffer), *count);
    if (*count == 0) ::usleep(200);
  }
  return text;
}

/// Reads until the link detects that it is down, for at most 1 s.
inline bool noticesEnd(Link& link) {
  for (int i = 0; i < 5000; ++i) {
    uint8_t buffer[256];
    if (!link.read(buffer, sizeof buffer)) return true;
    ::usleep(200);
  }
  return false;
}

/// Calls reopen() at times beyond every back-off, for at most 1 s.
inline bool comesBack(Link& link, int64_t& utime) {
  for (int i = 0; i < 100; ++i, utime += 10'000) {
    if (link.reopen(utime)) return true;
    ::usleep(1000);
  }
  utime += 1'000'000;
  return link.reopen(utime);
}

}  // namespace tread::testing
