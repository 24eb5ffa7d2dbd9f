// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/robot/launch/checks.hpp"

namespace tread::launch {

/// Asks this host about multicast; sends one datagram to the group, on a port of its own.
NetworkFacts networkFacts(const LcmAddress& address);

}  // namespace tread::launch
