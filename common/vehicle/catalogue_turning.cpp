// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/catalogue_parts.hpp"

namespace tread {

std::vector<Effect> turningEffects() {
  using V = EffectValues;
  return {
      {"slip_ratio",
       "Longitudinal slip",
       EffectKind::kVehicle,
       "xw",
       "Both tracks slip on the ground by the same share of their speed.",
       "w -> w (1 - slip), both tracks",
       "Speed and yaw rate are short by the same factor, at all speeds.",
       "Never from poses alone against wheel radius and command gain: those need a surveyed "
       "revolution of the sprocket. A slope or a trailer changes slip, not a radius.",
       "Mark a track shoe, drive ten of its revolutions straight, and tape the distance.",
       {strength("slip", "1", -0.3, 0.7, 0.1, &V::slip_ratio)}},
      {"terrain_change",
       "Change of ground",
       EffectKind::kVehicle,
       "xw",
       "From a certain moment on the ground is another one: slip and resistance to turning change.",
       "from time_1 of the session on slip_1, width_1 and breakaway_1 are added to slip_ratio, "
       "track_width and yaw_breakaway, from time_2 (if later than time_1) on those with _2 instead",
       "Residuals that belong to a part of the drive: different before and after a moment.",
       "Look where the vehicle was then; drive over the border once more, both ways. A battery or "
       "a hot motor changes gradually, a payload does not depend on the place.",
       "Walk to the place where the change was and look at the ground.",
       {strength("width_1", "1", -0.9, 3.0, 0.3, &V::terrain_width_1),
        strength("slip_1", "1", -0.5, 0.7, 0.1, &V::terrain_slip_1),
        strength("breakaway_1", "rad/s", -0.5, 0.5, 0.1, &V::terrain_breakaway_1),
        strength("width_2", "1", -0.9, 3.0, 0.3, &V::terrain_width_2),
        strength("slip_2", "1", -0.5, 0.7, 0.1, &V::terrain_slip_2),
        strength("breakaway_2", "rad/s", -0.5, 0.5, 0.1, &V::terrain_breakaway_2),
        shape(strength("time_1", "s", 0.0, 1e6, 300.0, &V::terrain_time_1)),
        shape(strength("time_2", "s", 0.0, 1e6, 600.0, &V::terrain_time_2))}},
      {"track_width",
       "Effective track width, steering efficiency",
       EffectKind::kVehicle,
       "w",
       "The vehicle turns as if its tracks were further apart than they are.",
       "omega -> omega / (1 + widening)",
       "The yaw rate is short by the same factor at all speeds and yaw rates; straight driving is "
       "right.",
       "Turn on the spot at three rates and in arcs at two speeds: only a width is the same "
       "everywhere.",
       "Turn ten times on the spot and compare with the turns that the tracks' travel gives.",
       {strength("widening", "1", -0.9, 4.0, 0.3, &V::track_width)}},
      {"yaw_rate_skid",
       "Skid that grows with the yaw rate",
       EffectKind::kVehicle,
       "w",
       "The faster it turns, the larger the share of turning that is lost.",
       "omega -> omega / (1 + skid |omega|)",
       "The yaw rate residual grows with the square of the yaw rate, against it.",
       "Three or more yaw rates on the spot: a width loses the same share at each.",
       "Turn on the spot at a quarter, a half and all of the power and compare the shares lost.",
       {strength("skid", "s", -0.3, 2.0, 0.15, &V::yaw_rate_skid)}},
      {"yaw_breakaway",
       "Break-away of turning, dry friction in yaw",
       EffectKind::kVehicle,
       "w",
       "Turning begins only above a certain difference of the tracks and lacks it ever after.",
       "omega -> sign(omega) max(0, |omega| - rate)",
       "The yaw rate is short by a constant; gentle turns at speed go straight.",
       "Small differences of the tracks at speed (0.1 to 0.6 m/s): a deadband of the motors does "
       "not show there, a width loses little.",
       "Drive at half speed and raise the difference of the tracks slowly until it turns.",
       {strength("rate", "rad/s", 0.0, 0.5, 0.1, &V::yaw_breakaway, {0.03, 0.1, 0.2})}},
      {"turn_power_limit",
       "Limit of turning power",
       EffectKind::kVehicle,
       "w",
       "The drive cannot turn the vehicle faster than a certain yaw rate on this ground.",
       "omega -> clip(omega, +-limit); inverse_limit = 1 / limit",
       "The yaw rate is right up to a value and flat beyond it, on the spot and at speed; the "
       "forward speed is right.",
       "Turn on the spot with a growing command; a limit of track speed caps the straight drive, "
       "too, a grip limit does not act on the spot.",
       "Turn on the spot at 60, 80 and 100 % and compare the yaw rates.",
       {inverseLimit("s/rad", 10.0, 0.7, &V::turn_power_limit, {0.25, 0.4, 0.6, 0.9, 1.4}, "limit",
                     "rad/s")}},
      {"speed_understeer",
       "Understeer with speed",
       EffectKind::kVehicle,
       "w",
       "The same difference of the tracks turns less the faster it drives.",
       "omega -> omega / (1 + gain v^2)",
       "The yaw rate is right on the spot and short at speed.",
       "The same difference of the tracks at three forward speeds.",
       "Drive the same difference of the tracks at walking pace and at full speed.",
       {strength("gain", "s2/m2", -0.1, 2.0, 0.05, &V::speed_understeer)}},
  };
}

}  // namespace tread
