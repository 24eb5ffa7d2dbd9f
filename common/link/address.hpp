// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>

namespace tread {

/// A link's address in parts.
struct LinkAddress {
  enum class Kind { kTty, kPty, kTcp, kTcpServer, kUdp, kFile };
  Kind kind = Kind::kTty;
  std::string text;   ///< as configured
  std::string path;   ///< tty, pty and file
  std::string host;   ///< tcp: name or number; tcp-server, udp: number to listen on, empty = all
  uint16_t port = 0;  ///< tcp, tcp-server and udp
  int baud = 115200;  ///< tty [1/s]
};

/// Takes an address apart; throws std::invalid_argument with one clear line.
LinkAddress parseLinkAddress(const std::string& text);

}  // namespace tread
