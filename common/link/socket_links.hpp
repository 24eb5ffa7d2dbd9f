// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>

#include "common/link/link.hpp"

namespace tread {

/// A TCP server with one client at a time: an emulated device. Open while a client is connected.
std::unique_ptr<Link> makeTcpServerLink(const LinkAddress& address);
/// A client of a TCP server. Connecting goes on over several reopen() calls and is given up after
/// one second.
/** A host's name is looked up once, which may block: on a robot write its number. */
std::unique_ptr<Link> makeTcpLink(const LinkAddress& address);
/// Listens on a UDP port (IPv4); datagrams follow each other in one stream. It never writes.
std::unique_ptr<Link> makeUdpLink(const LinkAddress& address);

}  // namespace tread
