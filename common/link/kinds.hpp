// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>

#include "common/link/address.hpp"
#include "common/link/link.hpp"

namespace tread {

/// A serial line or pseudo-terminal, raw, 8 data bits, no parity, one stop bit, no flow control.
std::unique_ptr<Link> makeTtyLink(const LinkAddress& address);
/// A new pseudo-terminal whose other side is found behind a symlink: an emulated serial device.
/** The symlink (and its folder) is made here and taken away with the link. Bytes that nobody reads
 * stay until the line is full, then are lost; who opens the other side drops them. */
std::unique_ptr<Link> makePtyLink(const LinkAddress& address);
/// A TCP server with one client at a time: an emulated device. Open while a client is connected.
std::unique_ptr<Link> makeTcpServerLink(const LinkAddress& address);
/// A client of a TCP server. Connecting goes on over several reopen() calls and is given up after
/// one second.
/** A host's name is looked up once, which may block: on a robot write its number. */
std::unique_ptr<Link> makeTcpLink(const LinkAddress& address);
/// Listens on a UDP port (IPv4); datagrams follow each other in one stream. It never writes.
std::unique_ptr<Link> makeUdpLink(const LinkAddress& address);
/// Reads a file once, from front to end; then it stays closed. It never writes.
std::unique_ptr<Link> makeFileLink(const LinkAddress& address);

}  // namespace tread
