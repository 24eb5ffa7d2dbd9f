// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/link/link.hpp"

namespace tread {

/// Parses an address; throws std::invalid_argument with one clear line.
LinkAddress parseLinkAddress(const std::string& text);

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
