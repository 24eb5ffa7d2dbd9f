// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>

#include "common/link/link.hpp"

namespace tread {

/// A CAN interface (SocketCAN): a sequence of whole struct can_frame.
std::unique_ptr<Link> makeCanLink(const LinkAddress& address);

}  // namespace tread
