// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Effects that only a car or only a holonomic base can have.
#include "common/vehicle/catalogue_layouts.hpp"

#include "common/vehicle/catalogue_parts.hpp"

namespace tread {
namespace {

std::optional<double> totalSteeringLag(const VehicleModel& model) {
  if (model.steering_lag == 0.0) return std::nullopt;
  return model.steeringLag();
}

std::vector<Effect> on(VehicleLayouts layouts, std::vector<Effect> effects) {
  for (Effect& effect : effects) effect.layouts = layouts;
  return effects;
}

Effect lossOfWheel(const std::string& number, double EffectValues::*value) {
  Effect effect;
  effect.name = "wheel_" + number + "_loss";
  effect.title = "Loss of wheel " + number;
  effect.channels = "xyw";
  effect.sentence = "Wheel " + number +
                    " gives less than it is asked for, by the same share at all speeds; the others "
                    "are right";
  effect.equation = "u_" + number + " -> u_" + number + " (1 - loss)";
  effect.looks_like =
      "Along the direction in which that wheel rolls it is too slow and turns, across it is right.";
  effect.separates = "Drives in six directions and turns on the spot: slip is the same in all.";
  effect.check =
      "Lift the base off the ground, command all wheels alike and count the revolutions of each; "
      "measure its radius.";
  effect.parameters = {strength("loss", "1", -0.5, 0.9, 0.06, value)};
  effect.negative_sentence =
      "Wheel " + number + " gives more than it is asked for, by the same share at all speeds";
  return effect;
}

}  // namespace

std::vector<Effect> steeringEffects() {
  using V = EffectValues;
  return on(
      kOfCars,
      {{"steering_ratio",
        "Steering ratio",
        "w",
        "The wheels turn by another share of the commanded angle than the model says.",
        "angle -> (1 + share) angle; adds to the model's steering_gain",
        "The yaw rate is wrong by the same factor at all speeds and angles; straight driving is "
        "right.",
        "Three angles at two speeds: understeer grows with the speed, a limit flattens large "
        "angles.",
        "Measure the angle of the wheels at a quarter, a half and all of the command.",
        {withSigns(strength("share", "1", -0.8, 2.0, 0.1, &V::steering_ratio),
                   "the wheels turn further", "the wheels turn less")},
        "",
        {{"steering_gain"}, 6}},
       {"steering_offset",
        "Steering offset",
        "w",
        "The wheels do not stand straight when they are told to.",
        "angle -> angle + offset",
        "It draws a bow to one side by an angle per metre, forwards and backwards, in curves, too.",
        "Stand still for 30 s: a gyro bias turns there, too. Drive forwards and backwards.",
        "Drive 20 m with the steering at 0 and measure the miss; look along the wheels.",
        {withSigns(strength("angle", "rad", -0.3, 0.3, 0.02, &V::steering_offset), "to the left",
                   "to the right")}},
       {"slow_steering",
        "Lag of the steering",
        "w",
        "The wheels take up a new angle gradually, fast at first.",
        "angle' = (command - angle) / lag; adds to the model's steering_lag",
        "After a change of the steering the yaw rate points to what was before; the speed is "
        "right.",
        "Steering steps of three sizes at constant speed: a limit of the rate takes longer for "
        "larger ones.",
        "Film the wheels during a step of the steering while it stands.",
        {addedTo(&VehicleModel::steering_lag, {"lag of the steering in all", "s", totalSteeringLag},
                 strength("lag", "s", -2.0, 3.0, 0.15, &V::slow_steering))},
        "The wheels take up a new angle sooner than the model says",
        {{"steering_lag"}, 7}},
       {"steering_rate",
        "Limit of the steering's rate",
        "w",
        "The wheels turn no faster than a certain rate, whatever the size of the step.",
        "|angle'| <= limit before the lag; inverse_limit = 1 / limit",
        "Straight ramps of the yaw rate after a change of the steering; twice the step takes twice "
        "the time.",
        "Steering steps of three sizes: with a lag the time does not depend on the size.",
        "Film the wheels while the steering goes from stop to stop.",
        {inverseLimit("s/rad", 20.0, 0.8, &V::steering_rate, {0.4, 0.8, 1.6, 3.0}, "limit",
                      "rad/s")}},
       {"steering_limit",
        "Stop of the steering",
        "w",
        "The wheels turn no further than a certain angle.",
        "|angle| <= limit; inverse_limit = 1 / limit",
        "The yaw rate is right up to an angle, and does not grow beyond it, at all speeds.",
        "The largest angles at two speeds: understeer and grip depend on the speed.",
        "Turn the steering to its stop and measure the angle of the wheels.",
        {inverseLimit("1/rad", 20.0, 3.0, &V::steering_limit, {2.0, 2.6, 3.5, 5.0, 8.0}, "limit",
                      "rad")}},
       {"steering_play",
        "Play of the steering",
        "w",
        "The linkage has play: the wheels stay a little behind, on the side from which they come.",
        "the angle follows the servo only where it is more than play / 2 from it",
        "The same command turns more or less than before, depending on where the steering came "
        "from; a small change of it does nothing.",
        "Steering to one angle from the left and from the right: an offset is the same.",
        "Turn a wheel by hand and measure how far it goes before the servo feels it.",
        {strength("play", "rad", 0.0, 0.4, 0.04, &V::steering_play, {0.02, 0.06, 0.12})}}});
}

std::vector<Effect> wheelEffects() {
  using V = EffectValues;
  return on(kOfOmni, {lossOfWheel("1", &V::wheel_1_loss), lossOfWheel("2", &V::wheel_2_loss),
                      lossOfWheel("3", &V::wheel_3_loss), lossOfWheel("4", &V::wheel_4_loss)});
}

std::vector<Effect> sidewaysEffects() {
  using V = EffectValues;
  return on(
      kOfOmni,
      {{"translation_loss",
        "Driving unlike turning",
        "xy",
        "In every direction it gets less far than its rims by the same share; turns are right.",
        "v_x -> v_x (1 - loss), v_y -> v_y (1 - loss)",
        "Too slow by the same share in all directions and at all speeds; the yaw rate is right.",
        "A surveyed distance: an INS whose positions are too short looks the same.",
        "Drive between two surveyed marks, and compare the way with the INS and with the wheels.",
        {strength("loss", "1", -0.5, 0.9, 0.08, &V::translation_loss)},
        "In every direction it gets further than its rims by the same share; turns are right"},
       {"sideways_loss",
        "Sideways unlike forward",
        "y",
        "Sideways it gets less far than its rims, forward it does not.",
        "v_y -> v_y (1 - loss), off the model's sideways_gain",
        "Too slow sideways by the same share at all speeds; forward and yaw rate are right.",
        "Drives in six directions: slip of all wheels is the same in all.",
        "Time 2 m forward and 2 m sideways at the same command.",
        {strength("loss", "1", -0.5, 0.9, 0.08, &V::sideways_loss)},
        "Sideways it gets further than its rims, forward it does not",
        {{"sideways_gain"}, 8}},
       {"sideways_lag",
        "Lag sideways",
        "y",
        "Sideways it takes up a new speed gradually, forward it does not.",
        "v_y' = (v_y_steady - v_y) / lag",
        "After a change of the sideways speed the residual across points to what was before.",
        "Steps forward and steps sideways: a lag of the drive shows in both.",
        "Stop from full speed sideways and measure how far it slides.",
        {strength("lag", "s", 0.0, 3.0, 0.15, &V::sideways_lag, {0.05, 0.15, 0.4})}},
       {"sideways_turn",
        "Turns as it moves sideways",
        "w",
        "It turns in proportion to its sideways speed: its mass or its grip is not in the middle.",
        "omega -> omega + pull v_y",
        "The yaw rate residual is proportional to the sideways speed and flips with it.",
        "Drives to the left and to the right; one wheel that gives less turns it in other "
        "directions, too.",
        "Drive 2 m sideways both ways and measure the turns; weigh front and rear.",
        {withSigns(strength("pull", "rad/m", -2.0, 2.0, 0.1, &V::sideways_turn),
                   "to the left going left", "to the right going left")}}});
}

}  // namespace tread
