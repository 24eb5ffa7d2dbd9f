// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

namespace tread::testing {

/// A bus for this test only, to which options may be added (&...): multicast, where only the port
/// separates buses with LCM 1.3.1; without multicast TCP, with a server in this test.
std::string ownLcmUrl();

/// The same for a tread-launch, which starts the server itself.
std::string launchedLcmUrl();

}  // namespace tread::testing
