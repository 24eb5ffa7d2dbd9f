// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace tread {

/// A link's address in parts.
struct LinkAddress {
  enum class Kind { kTty, kPty, kTcp, kTcpServer, kUdp, kFile, kCan };
  Kind kind = Kind::kTty;
  std::string text;   ///< as configured
  std::string path;   ///< tty, pty and file; can: the interface
  std::string host;   ///< tcp: name or number; tcp-server, udp: number to listen on, empty = all
  uint16_t port = 0;  ///< tcp, tcp-server and udp
  int baud = 115200;  ///< tty [1/s]
};

/// Byte stream to a device. A vanished line is closed at once and reopened by name with back-off.
/** Never waits for the device, with two exceptions: completing a partial write, 20 ms at most, and
 * resolving a TCP host name, which takes as long as the resolver does: use a numeric address on a
 * robot. */
class Link {
 public:
  virtual ~Link() = default;
  Link() = default;
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// Bytes available now (0 = none at present); nullopt if the link is down or at its end.
  virtual std::optional<size_t> read(uint8_t* buffer, size_t capacity) = 0;
  /// Writes all bytes or none; false if the line is down or full. A stale command is dropped, never
  /// queued.
  virtual bool write(const uint8_t* bytes, size_t size) = 0;
  virtual bool isOpen() const = 0;
  /// Tries to open a closed link; attempts are spaced by a back-off from 100 ms up to 1 s. True if
  /// open now.
  virtual bool reopen(int64_t utime) = 0;
  /// Closes an open link, for instance if a device needs a new connection; reopen() opens it again.
  virtual void close() = 0;
  /// Descriptor to poll, or -1.
  virtual int descriptor() const { return -1; }
  /// Address as configured, for messages.
  virtual const std::string& address() const = 0;
  /// Why it is closed, in one line; empty when open, or closed by close().
  virtual std::string problem() const = 0;
};

}  // namespace tread
