// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/catalogue_parts.hpp"

namespace tread {

std::vector<Effect> measurementEffects() {
  using M = MeasurementModel;
  constexpr EffectKind kMeasured = EffectKind::kMeasurement;
  return {
      {"ins_latency",
       "INS latency, clock offset",
       kMeasured,
       "xyw",
       "The INS says where the vehicle was a while ago.",
       "pose(t) -> pose(t - latency), yaw rate(t) -> yaw rate(t - gyro_share latency)",
       "Residuals wherever the motion changes; heading and integrated gyro are out of step.",
       "Correlate heading and gyro; hardware time stamps or a pulse per second. If the gyro is as "
       "late as the pose it cannot be told from a delay of the commands.",
       "Turn the vehicle to and fro; compare the moments at which heading and gyro reverse.",
       {strength("latency", "s", -1.0, 2.0, 0.2, &M::ins_latency),
        shape(strength("gyro_share", "1", 0.0, 1.0, 0.0, &M::ins_latency_gyro))}},
      {"heading_latency",
       "Heading late against position",
       kMeasured,
       "yw",
       "The heading of a pose is older than its position.",
       "heading(t) -> heading(t - latency), position as it is",
       "The lateral residual is proportional to speed times yaw rate: like a drift inwards for a "
       "late heading, outwards for a late position (negative).",
       "Another surface: a latency is the same everywhere, a drift changes with the grip.",
       "Drive a tight circle on tarmac and on grass and compare.",
       {strength("latency", "s", -0.5, 0.5, 0.1, &M::heading_latency)}},
      {"position_scale",
       "Scale of positions",
       kMeasured,
       "xy",
       "Distances of the INS are too long or too short by a share (wrong datum, odometer scale).",
       "p -> (1 + scale) p",
       "The residual along the track is proportional to the speed; headings are right.",
       "A surveyed distance. From poses alone it is slip and track width together.",
       "Drive between two surveyed marks and compare.",
       {strength("scale", "1", -0.2, 0.2, 0.02, &M::position_scale)}},
      {"lever_arm_x",
       "Lever arm along the vehicle",
       kMeasured,
       "y",
       "The INS reports a point that is so far behind the vehicle's middle (configured lever arm "
       "less the true one).",
       "p -> p - R(yaw) (offset, 0): v_y -> v_y - offset omega",
       "The lateral residual is proportional to the yaw rate, on the spot, too.",
       "Measure the lever arm with a tape; a centre of rotation moves with ground and payload.",
       "Tape the distance from antenna to middle and compare with the INS configuration.",
       {strength("offset", "m", -1.0, 1.0, 0.1, &M::lever_arm_x)}},
      {"lever_arm_y",
       "Lever arm across the vehicle",
       kMeasured,
       "x",
       "The INS reports a point that is so far to the right of the vehicle's middle (configured "
       "lever arm less the true one).",
       "p -> p - R(yaw) (0, offset): v_x -> v_x + offset omega",
       "The residual along the track is proportional to the yaw rate, odd: too fast in one turn, "
       "too slow in the other.",
       "Measure the lever arm with a tape; turn on the spot both ways.",
       "Tape the distance from antenna to the middle line and compare.",
       {strength("offset", "m", -1.0, 1.0, 0.1, &M::lever_arm_y)}},
      {"heading_misalignment",
       "INS mounted askew",
       kMeasured,
       "y",
       "The INS's heading is turned against the vehicle's by a constant.",
       "heading -> heading - angle: v_y -> v_y + angle v",
       "The lateral residual is proportional to the speed and flips in reverse.",
       "Turn the vehicle round on the same line: a slope flips in the body, misalignment stays.",
       "Drive straight along a chalk line and compare the INS heading with its direction.",
       {strength("angle", "rad", -0.3, 0.3, 0.04, &M::heading_misalignment)}},
      {"gyro_bias",
       "Gyro bias, heading drift",
       kMeasured,
       "w",
       "The gyro reports a turn that is not there.",
       "omega -> omega + rate; heading -> heading + heading_share rate T",
       "A constant yaw rate residual, at standstill, too.",
       "Standing still for 30 s at start and end.",
       "Stand still for 30 s and read the yaw rate.",
       {strength("rate", "rad/s", -0.2, 0.2, 0.02, &M::gyro_bias),
        shape(strength("heading_share", "1", 0.0, 1.0, 0.0, &M::gyro_bias_heading))}},
  };
}

}  // namespace tread
