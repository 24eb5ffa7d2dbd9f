// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>

#include "common/link/link.hpp"

namespace tread {

/// A TCP server with one client at a time: an emulated device. Open while a client is connected.
std::unique_ptr<Link> makeTcpServerLink(const LinkAddress& address);
/// A client of a TCP server. Connecting continues over several reopen() calls and is given up after
/// one second.
/** A host name is resolved once, which may block: use a numeric address on a robot. */
std::unique_ptr<Link> makeTcpLink(const LinkAddress& address);
/// Listens on a UDP port (IPv4); datagrams are concatenated into one stream. It never writes.
std::unique_ptr<Link> makeUdpLink(const LinkAddress& address);

}  // namespace tread
