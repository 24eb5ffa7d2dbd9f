// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>

#include "common/link/link.hpp"

namespace tread {

/// A serial line or pseudo-terminal, raw, 8 data bits, no parity, one stop bit, no flow control.
std::unique_ptr<Link> makeTtyLink(const LinkAddress& address);
/// A new pseudo-terminal whose other side is found behind a symlink: an emulated serial device.
/** The symlink (and its folder) is made here and taken away with the link. Bytes that nobody reads
 * stay until the line is full, then are lost; who opens the other side drops them. */
std::unique_ptr<Link> makePtyLink(const LinkAddress& address);

}  // namespace tread
