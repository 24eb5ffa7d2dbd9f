// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/catalogue_parts.hpp"

namespace tread {

std::vector<Effect> speedEffects() {
  using V = EffectValues;
  return {
      {"turn_speed_loss",
       "Loss of speed in turns",
       EffectKind::kVehicle,
       "x",
       "Turning costs forward speed.",
       "v -> v / (1 + loss |omega|)",
       "Too slow in left and right turns alike, right on the straight.",
       "The same mean track speed at several yaw rates.",
       "Time a full circle and a straight of the same length at equal mean command.",
       {strength("loss", "s", -0.5, 2.0, 0.15, &V::turn_speed_loss)}},
      {"reverse_speed_gain",
       "Speed unlike in reverse",
       EffectKind::kVehicle,
       "x",
       "It is faster in one direction of travel than in the other.",
       "v -> v + gain |v|",
       "Too fast forwards and too slow backwards, or the other way round, in proportion to the "
       "speed.",
       "The same straight forwards and backwards.",
       "Time 10 m forwards and 10 m backwards.",
       {strength("gain", "1", -0.5, 0.5, 0.05, &V::reverse_speed_gain)}},
      {"quadratic_drag",
       "Drag that grows with speed",
       EffectKind::kVehicle,
       "x",
       "The faster it drives, the larger the share of speed that is lost.",
       "v -> v - drag v |v|",
       "The residual grows with the square of the speed, against it; the yaw rate is right.",
       "Three speeds straight ahead: slip loses the same share at each, rolling resistance the "
       "same speed.",
       "Time 20 m at a third, two thirds and all of full speed.",
       {strength("drag", "s/m", -0.1, 0.5, 0.05, &V::quadratic_drag)}},
      {"rolling_resistance",
       "Rolling resistance, dry friction",
       EffectKind::kVehicle,
       "x",
       "The vehicle is slower than its tracks by a constant and does not creep at all.",
       "v -> sign(v) max(0, |v| - speed)",
       "Too slow by the same amount at all speeds, forwards and backwards; the yaw rate is right.",
       "Gentle turns: a deadband of the motors changes their yaw rate, rolling resistance does "
       "not.",
       "Raise the command slowly and compare the speed of the tracks with that of the vehicle.",
       {strength("speed", "m/s", 0.0, 0.5, 0.05, &V::rolling_resistance, {0.03, 0.08, 0.15})}},
  };
}

}  // namespace tread
