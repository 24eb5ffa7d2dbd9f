// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/messages/permission.hpp"

#include <algorithm>

namespace tread {

void DrivingPermission::revoke(int64_t utime) {
  armed_ = false;
  revoked_ = std::max(revoked_, utime);
}

void DrivingPermission::take(const arm_t& message, int64_t now) {
  if (!message.armed) return revoke(std::min(message.utime, now));
  const bool timely = message.utime <= now + kMaxFuture && message.utime >= now - kMaxAge;
  if (timely && message.utime > revoked_ && !estopped_) armed_ = true;
}

void DrivingPermission::take(const estop_t& message, int64_t now) {
  // A stop counts whatever its time says; only clearing must be newer than what it clears.
  const int64_t utime = std::min(message.utime, now);
  if (!message.engaged && utime < estop_utime_) return;
  estop_utime_ = std::max(estop_utime_, utime);
  estopped_ = message.engaged;
  if (estopped_) revoke(utime);
}

void DrivingPermission::take(const BridgeReading& bridge) {
  if (bridge_armed_ && !bridge.armed()) revoke(bridge.utime);
  bridge_armed_ = bridge.armed();
}

}  // namespace tread
