// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "modules/motor_bridge/core/roboteq_codec.hpp"

namespace tread::motor {

/// What the controller last told about itself; NaN and nothing = unknown.
struct RoboteqTelemetry {
  double battery_voltage = std::numeric_limits<double>::quiet_NaN();  ///< [V]
  double current_left = std::numeric_limits<double>::quiet_NaN();     ///< [A]
  double current_right = std::numeric_limits<double>::quiet_NaN();
  double speed_left = std::numeric_limits<double>::quiet_NaN();  ///< track speed [m/s], + forward
  double speed_right = std::numeric_limits<double>::quiet_NaN();
  int32_t fault_flags = 0;                ///< ?FF
  int32_t status_flags = 0;               ///< ?FS
  std::optional<int64_t> faults_read_at;  ///< [us]
  std::optional<int64_t> status_read_at;  ///< [us]

  /// Takes the reply to a query, received at now [us]. False if it is not one of these or
  /// malformed.
  bool take(const RoboteqReply& reply, const RoboteqLayout& layout, int64_t now);
};

}  // namespace tread::motor
