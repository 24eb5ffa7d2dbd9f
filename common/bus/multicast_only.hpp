// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

namespace lcm {
class LCM;
}

namespace tread {

/// Makes LCM's receive socket, for which LCM tests itself, and closes it to everything that was not
/// sent to the URL's multicast group. Call it before anything is subscribed.
/** LCM 1.3.1 binds its port on every address: a plain datagram from another host reaches the
 * process that bound last, whatever ttl and multicast route say. The kernel drops it here, and so
 * does it a datagram to a group that each host has joined, as 224.0.0.1. False if LCM cannot be
 * used; throws std::runtime_error, one line, if its socket is not found or cannot be closed. URLs
 * without multicast have no such socket. */
bool openForMulticastOnly(lcm::LCM& lcm, const std::string& url);

}  // namespace tread
