// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// From the command to the speed of a track.
#include "common/vehicle/catalogue_drive.hpp"

#include "common/vehicle/catalogue_parts.hpp"

namespace tread {
namespace {

std::optional<double> totalDelay(const VehicleModel& model) {
  if (model.delay == 0.0) return std::nullopt;
  return model.commandDelay();
}

std::optional<double> totalLag(const VehicleModel& model) {
  if (model.lag == 0.0) return std::nullopt;
  return model.driveLag();
}

std::optional<double> lagWhileSlowing(const VehicleModel& model) {
  return std::max(0.0, model.driveLag() + model.effects.lag_asymmetry);
}

}  // namespace

std::vector<Effect> commandEffects() {
  using V = EffectValues;
  return {
      {"command_delay",
       "Command delay",
       "xw",
       "A command takes a fixed time before anything of it reaches the motors.",
       "u(t) -> u(t - delay); adds to the model's delay",
       "Nothing happens for a fixed time after each change of the command, then all at once; the "
       "residual follows the latest command change in speed and yaw rate alike.",
       "A witness that does not pass through the INS: wheel encoders, motor current or a hardware "
       "time stamp. Without one, delay and INS latency add up to one number.",
       "Film the tracks and a lamp on the command line during one start; count the frames.",
       {searchedFromSlope(addedTo(
           &VehicleModel::delay, {"delay in all", "s", totalDelay},
           strength("delay", "s", -2.0, 2.0, 0.1, &V::command_delay, {0.05, 0.1, 0.2, 0.3})))},
       "A command acts earlier than the model says",
       isLate(LateBy::kCommand, {{"delay"}, 4})},
      {"motor_deadband",
       "Motor deadband, stiction",
       "xw",
       "Small commands do not move a track, and larger ones lose the same amount.",
       "u -> sign(u) max(0, |u| - speed), each track",
       "Too slow by a constant, forwards and backwards; the slow inner track of a gentle turn "
       "loses "
       "most of its speed, so that gentle turns are too tight.",
       "Raise one track's command slowly from 0 to 20 %, then turn about the other, stopped track; "
       "rolling resistance does not touch the yaw rate.",
       "Raise the stick slowly and read the command at which each track begins to move.",
       {strength("speed", "m/s", 0.0, 0.5, 0.08, &V::motor_deadband, {0.03, 0.08, 0.15})}},
      {"speed_saturation",
       "Speed saturation",
       "xw",
       "A track does not run faster than a certain speed, whatever is asked of it.",
       "u -> clip(u, +-limit), each track; inverse_limit = 1 / limit",
       "Right up to a speed, flat above it, straight ahead and for the outer track of fast turns.",
       "Drive straight at the top command and fast arcs: a limit of turning power leaves the "
       "straight drive alone, a weak battery shrinks all commands.",
       "Drive straight at 70, 85 and 100 % of the command and compare the three speeds.",
       {inverseLimit("s/m", 10.0, 0.8, &V::speed_saturation, {0.25, 0.4, 0.6, 0.9, 1.2}, "limit",
                     "m/s", LimitedQuantity::kTrackSpeed)}},
  };
}

namespace {

/// One track alone; an asymmetry plus slip of both tracks gives the same.
Effect oneSided(const std::string& side, double EffectValues::*value) {
  const std::string other = side == "left" ? "right" : "left";
  Effect effect;
  effect.name = side + "_track_loss";
  effect.title = "Loss of the " + side + " track";
  effect.channels = "xw";
  effect.sentence = "The " + side +
                    " track gives less than it is asked for, by the same share at " +
                    "all speeds; the " + other + " one is right";
  effect.equation = "u_" + side + " -> u_" + side + " (1 - loss)";
  effect.looks_like = "Driving straight it turns to the " + side +
                      ", by an angle per metre, and is too slow by half of what that track lacks.";
  effect.separates =
      "Straight drives and turns both ways: an asymmetry keeps the mean speed, a pull is not in "
      "the "
      "wheels. Wheel speeds tell a drive that gives less from a sprocket that is smaller.";
  effect.check =
      "Lift the vehicle off the ground, command both tracks alike, and count the "
      "revolutions of both sprockets; measure the sprockets.";
  effect.parameters = {strength("loss", "1", -0.5, 0.9, 0.06, value)};
  effect.negative_sentence =
      "The " + side + " track gives more than it is asked for, by the same share at all speeds";
  effect.search = inPlace();
  effect.layouts = kOfTracks;
  return effect;
}

}  // namespace

std::vector<Effect> powerEffects() {
  using V = EffectValues;
  return {
      {"battery_sag",
       "Battery sag",
       "xw",
       "The tracks slow down as the battery empties.",
       "u -> u (1 - per_hour T / 3600 s - per_drop drop), T since the start of the session, drop: "
       "relative fall of the voltage where it is measured",
       "Speed and yaw rate fall together in proportion to the command, more with each minute.",
       "Come back to the same patch of ground at the end; a heated motor recovers in a rest, a "
       "battery does not.",
       "Read the voltage at the start and now, standing and at full speed.",
       {strength("per_hour", "1/h", -3.0, 6.0, 0.3, &V::battery_sag_per_hour),
        needsVoltage(strength("per_drop", "1", -1.0, 3.0, 1.0, &V::battery_sag_per_drop))},
       "The tracks get faster with time"},
      {"thermal_derating",
       "Thermal derating",
       "xw",
       "Motors or their controller give less after hard work and recover in a rest.",
       "u -> u (1 - loss E), E' = ((u / full_speed)^2 - E) / time_constant, each track; full_speed "
       "is 1 m/s for track speed commands",
       "Speed and yaw rate fall with the work of the last minutes, not with the time of day.",
       "Drive hard, rest for some minutes, repeat the same drive: heat goes, an empty battery "
       "stays.",
       "Feel or read the temperature of motors and controller after ten minutes of full power.",
       {strength("loss", "1", 0.0, 0.9, 0.15, &V::thermal_derating),
        fitted(shape(strength("time_constant", "s", 10.0, 3600.0, 240.0, &V::thermal_time,
                              {60.0, 240.0, 900.0})))}},
      only(kOfTracks,
           {"track_asymmetry",
            "Left-right asymmetry",
            "xw",
            "One track runs a little faster than the other at the same command.",
            "u_left -> u_left (1 + share), u_right -> u_right (1 - share)",
            "Driving straight it turns to the side of the slower track, by an angle per metre; the "
            "yaw "
            "rate residual is proportional to the speed and flips in reverse.",
            "Drive the same line forwards and backwards: asymmetry flips the sign of the yaw rate, "
            "a "
            "gyro bias does not; drive it both ways: a slope to the side flips in the body.",
            "Drive 20 m along a line with equal commands, then back in reverse; measure both "
            "misses.",
            {withSigns(strength("share", "1", -0.3, 0.3, 0.03, &V::track_asymmetry),
                       "the left track is the faster one", "the right track is the faster one")}}),
      oneSided("left", &V::left_track_loss),
      oneSided("right", &V::right_track_loss),
  };
}

std::vector<Effect> lagEffects() {
  using V = EffectValues;
  return {
      {"actuator_lag",
       "First-order lag of the drive",
       "xw",
       "The tracks approach a new speed gradually, fast at first.",
       "w' = (u - w) / lag, each track; adds to the model's lag",
       "Residuals after each change of command, in proportion to the change, gone in steady "
       "motion.",
       "Steps of different size, sampled at 10 Hz or more: a lag decays from the start, a delay "
       "shifts, an acceleration limit takes longer for larger steps.",
       "Step the command from rest to half speed and look how long the last third takes.",
       {addedTo(&VehicleModel::lag, {"lag in all", "s", totalLag},
                strength("lag", "s", -5.0, 5.0, 0.2, &V::actuator_lag))},
       "The tracks take up a new speed sooner than the model says",
       isLate(LateBy::kDrive, {{"lag"}, 3})},
      {"lag_asymmetry",
       "Slowing unlike speeding up",
       "xw",
       "Braking takes longer or shorter than speeding up.",
       "w' = (u - w) / (lag + slowing) while a track slows down or reverses",
       "Residuals in speed and yaw rate only when a track slows down.",
       "Up-steps and down-steps of the same size; slack of a track costs a distance instead and "
       "only after a reversal.",
       "Time the start to half speed and the stop from it.",
       {withTotal(
           {"lag while slowing", "s", lagWhileSlowing},
           withSigns(strength("slowing", "s", -2.0, 2.0, 0.15, &V::lag_asymmetry, {-0.1, 0.15}),
                     "braking takes longer", "braking is quicker"))}},
      {"slew_limit",
       "Acceleration limit",
       "xw",
       "What a drive is asked for changes no faster than a certain rate.",
       "|u'| <= limit before the lag, each track; inverse_limit = 1 / limit",
       "Straight ramps after a change of command; twice the step takes twice the time.",
       "Steps of three sizes: with a lag the time does not depend on the size.",
       "Step from rest to a third, two thirds and all of full speed and time each.",
       {inverseLimit("s2/m", 20.0, 0.5, &V::slew_limit, {0.2, 0.4, 0.8, 1.6}, "limit", "m/s2")}},
      only(kOfTracks,
           {"track_backlash",
            "Track slack, backlash",
            "xw",
            "After a reversal a track does not pull until its slack is taken up.",
            "no motion of a track until its drive has gone slack metres after a change of "
            "direction; a "
            "track at rest is taken up forwards",
            "Residuals only after the sign of a track's command has changed: always the same "
            "distance, "
            "not the same time.",
            "Reversals at two speeds: the time lost halves when the speed doubles.",
            "Rock the vehicle by hand, or turn the sprocket back and forth and measure the play.",
            {strength("slack", "m", 0.0, 0.3, 0.04, &V::track_backlash, {0.02, 0.06})}}),
  };
}

}  // namespace tread
