// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/link/link.hpp"

namespace tread {

/// Takes an address apart; throws std::invalid_argument with one clear line.
LinkAddress parseLinkAddress(const std::string& text);

/// Opens a link from its address: tty:/dev/ttyUSB0?baud=115200 · tcp:host:port · udp:port (listens)
/// · can:can0 (SocketCAN, struct can_frame of 16 bytes each) · file:path (reads); for emulated
/// devices pty:path (makes path) · tcp-server:[host:]port.
/** Throws std::invalid_argument for a malformed address (one clear line); a device that is absent
 * is not an error: the link is closed and reopen() tries again. */
std::unique_ptr<Link> makeLink(const std::string& address);

/// Throws std::runtime_error with one clear line if another program has this device now: at the
/// start, before anybody takes this process for the one that works it.
void requireFree(const Link& link);

/// Throws std::runtime_error with one clear line if an address listens (tcp-server, udp) and
/// cannot, because another program has the port for instance: what --check tries.
void requireListening(const std::string& address);

/// Two ends of an in-memory pipe, each direction holding at most `capacity` bytes. For virtual time
/// and tests.
std::pair<std::unique_ptr<Link>, std::unique_ptr<Link>> makePipe(size_t capacity = 65536);

/// Cuts or mends a pipe from either end, as pulling a plug does: unread bytes are gone.
void setPipeConnected(Link& end, bool connected);

}  // namespace tread
