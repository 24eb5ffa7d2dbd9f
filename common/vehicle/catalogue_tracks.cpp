// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/catalogue_parts.hpp"

namespace tread {

std::vector<Effect> trackEffects() {
  using V = EffectValues;
  return {
      {"actuator_lag",
       "First-order lag of the drive",
       EffectKind::kVehicle,
       "xw",
       "The tracks approach a new speed gradually, fast at first.",
       "w' = (u - w) / lag, each track; adds to the model's lag",
       "Residuals after each change of command, in proportion to the change, gone in steady "
       "motion.",
       "Steps of different size, sampled at 10 Hz or more: a lag decays from the start, a delay "
       "shifts, an acceleration limit takes longer for larger steps.",
       "Step the command from rest to half speed and look how long the last third takes.",
       {strength("lag", "s", -5.0, 5.0, 0.2, &V::actuator_lag)}},
      {"lag_asymmetry",
       "Slowing unlike speeding up",
       EffectKind::kVehicle,
       "xw",
       "Braking takes longer or shorter than speeding up.",
       "w' = (u - w) / (lag + slowing) while a track slows down or reverses",
       "Residuals in speed and yaw rate only when a track slows down.",
       "Up-steps and down-steps of the same size; slack of a track costs a distance instead and "
       "only after a reversal.",
       "Time the start to half speed and the stop from it.",
       {strength("slowing", "s", -2.0, 2.0, 0.15, &V::lag_asymmetry, {-0.1, 0.15})}},
      {"slew_limit",
       "Acceleration limit",
       EffectKind::kVehicle,
       "xw",
       "A track's speed changes no faster than a certain rate.",
       "|w'| <= limit, each track; inverse_limit = 1 / limit",
       "Straight ramps after a change of command; twice the step takes twice the time.",
       "Steps of three sizes: with a lag the time does not depend on the size.",
       "Step from rest to a third, two thirds and all of full speed and time each.",
       {inverseLimit("s2/m", 20.0, 0.5, &V::slew_limit, {0.2, 0.4, 0.8, 1.6}, "limit", "m/s2")}},
      {"track_backlash",
       "Track slack, backlash",
       EffectKind::kVehicle,
       "xw",
       "After a reversal a track does not pull until its slack is taken up.",
       "no motion of a track until its drive has gone slack metres after a change of direction; a "
       "track at rest is taken up forwards",
       "Residuals only after the sign of a track's command has changed: always the same distance, "
       "not the same time.",
       "Reversals at two speeds: the time lost halves when the speed doubles.",
       "Rock the vehicle by hand, or turn the sprocket back and forth and measure the play.",
       {strength("slack", "m", 0.0, 0.3, 0.04, &V::track_backlash, {0.02, 0.06})}},
  };
}

}  // namespace tread
