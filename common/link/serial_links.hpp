// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>

#include "common/link/link.hpp"

namespace tread {

/// A serial line or pseudo-terminal, raw, 8 data bits, no parity, one stop bit, no flow control.
std::unique_ptr<Link> makeTtyLink(const LinkAddress& address);
/// A new pseudo-terminal whose other side is reachable by a symlink: an emulated serial device.
/** The symlink (and its folder) is created here and removed with the link. Unread bytes stay until
 * the line is full, then are lost; opening the other side discards them. */
std::unique_ptr<Link> makePtyLink(const LinkAddress& address);

}  // namespace tread
