// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "lcmtypes/enums.hpp"

namespace tread {

/// Whether the robot may start to drive in this state without another ARM.
constexpr bool isArmed(BridgeState state) {
  return state == BridgeState::kArmed || state == BridgeState::kDriving ||
         state == BridgeState::kStopping || state == BridgeState::kManual;
}

}  // namespace tread
