// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>

#include <tread/arm_t.hpp>
#include <tread/estop_t.hpp>

#include "common/execution/readings.hpp"

namespace tread {

/// Whether the operator allows this run of a process to drive.
/** A permission counts if it was given after its start and after the last stop that took
 * it away: an order to disarm, an emergency stop, or a motor bridge that is not armed any more. */
class DrivingPermission {
 public:
  explicit DrivingPermission(int64_t start) : revoked_(start) {}
  /// As if started at this time.
  void restart(int64_t utime) { revoke(utime); }

  void take(const arm_t& message, int64_t now);
  void take(const estop_t& message, int64_t now);
  void take(const BridgeReading& bridge);

  bool armed() const { return armed_; }
  bool estopped() const { return estopped_; }

 private:
  static constexpr int64_t kMaxAge = 1'500'000;  ///< [us] ARM is repeated for a second
  static constexpr int64_t kMaxFuture = 50'000;  ///< [us]
  void revoke(int64_t utime);

  int64_t revoked_;  ///< [us] permissions given before count for nothing
  bool armed_ = false;
  bool bridge_armed_ = false;
  bool estopped_ = false;
  int64_t estop_utime_ = 0;
};

}  // namespace tread
