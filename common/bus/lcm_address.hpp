// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace tread {

/// An LCM URL in parts, as liblcm 1.3.1 reads it.
struct LcmAddress {
  std::string provider = "udpm";
  std::string group = "239.255.76.67";  ///< with tcpq the server's host
  uint16_t port = 7667;
  int ttl = 0;
  int64_t receive_buffer = 0;  ///< byte; 0 = the kernel's default
};

/// Takes an LCM URL apart; nullopt if it is malformed.
std::optional<LcmAddress> parseLcmUrl(const std::string& url);

/// The URL that LCM uses for this one: LCM_DEFAULT_URL or LCM's own default if it is empty.
std::string effectiveLcmUrl(const std::string& url);

}  // namespace tread
