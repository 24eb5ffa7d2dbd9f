// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/roboteq_telemetry.hpp"

#include <utility>

namespace tread::motor {
namespace {

/// Values of channels 1 and 2 as left and right.
std::pair<double, double> toSides(const std::vector<long>& values, const RoboteqLayout& layout) {
  const auto one = static_cast<double>(values[0]);
  const auto two = static_cast<double>(values[1]);
  return layout.left_channel == 1 ? std::pair(one, two) : std::pair(two, one);
}

/// Flags are at most 16 bits: what is beyond them is a garbled line, and cut off could read as "no
/// fault".
bool areFlags(const std::vector<long>& values) {
  return values.size() == 1 && values[0] >= 0 && values[0] <= 0xffff;
}

}  // namespace

bool RoboteqTelemetry::take(const RoboteqReply& reply, const RoboteqLayout& layout, int64_t now) {
  const std::vector<long>& values = reply.values;
  if (reply.key == "A" && values.size() >= 2) {
    const auto [left, right] = toSides(values, layout);
    current_left = left / 10.0;
    current_right = right / 10.0;
  } else if (reply.key == "V" && values.size() >= 2) {
    battery_voltage = static_cast<double>(values[1]) / 10.0;
  } else if (reply.key == "S" && values.size() >= 2 && layout.rpm_per_mps > 0.0) {
    const auto [left, right] = toSides(values, layout);
    speed_left = (layout.invert_left ? -left : left) / layout.rpm_per_mps;
    speed_right = (layout.invert_right ? -right : right) / layout.rpm_per_mps;
  } else if (reply.key == "FF" && areFlags(values)) {
    fault_flags = static_cast<int32_t>(values[0]);
    faults_read_at = now;
  } else if (reply.key == "FS" && areFlags(values)) {
    status_flags = static_cast<int32_t>(values[0]);
    status_read_at = now;
  } else {
    return false;
  }
  return true;
}

}  // namespace tread::motor
