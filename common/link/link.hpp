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

/// Parses an address; throws std::invalid_argument with one clear line.
LinkAddress parseLinkAddress(const std::string& text);

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

/// Opens a link from its address: tty:/dev/ttyUSB0?baud=115200 · tcp:host:port · udp:port (listens)
/// · can:can0 (SocketCAN, struct can_frame of 16 bytes each) · file:path (reads); for emulated
/// devices pty:path (makes path) · tcp-server:[host:]port.
/** Throws std::invalid_argument for a malformed address (one clear line). An absent device is no
 * error: the link is closed and reopen() tries again. */
std::unique_ptr<Link> makeLink(const std::string& address);

/// Throws std::runtime_error with one clear line if another program has this device now: checked at
/// the start, before anybody believes that this process runs it.
void requireFree(const Link& link);

/// Throws std::runtime_error with one clear line if a listening address (tcp-server, udp) cannot
/// listen, for instance because another program has the port: used by --check.
void requireListening(const std::string& address);

/// Two ends of an in-memory pipe, each direction holding at most `capacity` bytes. For virtual time
/// and tests.
std::pair<std::unique_ptr<Link>, std::unique_ptr<Link>> makePipe(size_t capacity = 65536);

/// Cuts or restores a pipe from either end, as unplugging does: unread bytes are lost.
void setPipeConnected(Link& end, bool connected);

}  // namespace tread
