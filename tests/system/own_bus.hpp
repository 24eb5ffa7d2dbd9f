// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

namespace tread::testing {

/// A bus of this test alone, to which options may be added (&...): multicast, where only the port
/// separates buses with LCM 1.3.1; where there is no multicast, TCP through a server in this test.
std::string ownLcmUrl();

/// The same for a tread-launch, which brings the server with it.
std::string launchedLcmUrl();

}  // namespace tread::testing
