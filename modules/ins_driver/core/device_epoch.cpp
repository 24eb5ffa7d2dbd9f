// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/core/device_epoch.hpp"

namespace tread::ins {
namespace {

template <class Report>
void takeRanked(std::optional<Report>& held, const std::optional<Report>& told) {
  if (told && (!held || told->rank >= held->rank)) held = told;
}

template <class Value>
void takeTold(std::optional<Value>& held, const std::optional<Value>& told) {
  if (told) held = told;
}

}  // namespace

GroundVelocity groundVelocity(double north, double east, double up, double std, int rank) {
  GroundVelocity velocity{std::hypot(north, east), {}, up, std, rank};
  if (velocity.speed > 0.0) velocity.course = std::atan2(north, east);
  return velocity;
}

void DeviceEpoch::take(const DeviceEpoch& part, size_t kind) {
  kinds |= 1U << kind;
  takeRanked(position, part.position);
  takeRanked(velocity, part.velocity);
  for (size_t i = 0; i < headings.size(); ++i) takeTold(headings[i], part.headings[i]);
  if (part.pitch) pitch_std = part.pitch_std;
  if (part.roll) roll_std = part.roll_std;
  takeTold(pitch, part.pitch);
  takeTold(roll, part.roll);
  takeTold(yaw_rate, part.yaw_rate);
  takeTold(rate_device, part.rate_device);
  if (part.satellites >= 0) satellites = part.satellites;
}

}  // namespace tread::ins
