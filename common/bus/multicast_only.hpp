// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

namespace lcm {
class LCM;
}

namespace tread {

/// Creates LCM's receive socket (LCM tests itself through it) and restricts it to packets sent to
/// the URL's multicast group. Call it before the first subscription.
/** LCM 1.3.1 binds its port on every address: a plain datagram from another host reaches the
 * process that bound last, whatever ttl and multicast route are. With this call the kernel drops
 * it, and also datagrams to groups that every host has joined, such as 224.0.0.1. False if LCM
 * cannot be used; throws std::runtime_error, one line, if its socket is not found or cannot be
 * restricted. URLs without multicast have no such socket. */
bool openForMulticastOnly(lcm::LCM& lcm, const std::string& url);

}  // namespace tread
