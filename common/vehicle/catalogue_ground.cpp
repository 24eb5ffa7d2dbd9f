// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// What the ground makes of the tracks: slip, turning and losses of speed.
#include "common/vehicle/catalogue_ground.hpp"

#include "common/vehicle/catalogue_parts.hpp"

namespace tread {
namespace {

std::optional<double> effectiveWidth(const VehicleModel& model) {
  return model.gauge * (1.0 + model.effects.track_width) / model.yaw_gain;
}

std::optional<double> speedOverTracks(const VehicleModel& model) {
  if (model.forward_gain == 1.0) return std::nullopt;
  return model.forward_gain * (1.0 - model.effects.slip_ratio);
}

}  // namespace

std::vector<Effect> slipEffects() {
  using V = EffectValues;
  return {
      {"slip_ratio",
       "Longitudinal slip",
       "xw",
       "Both tracks slip on the ground by the same share of their speed.",
       "w -> w (1 - slip), both tracks",
       "Speed and yaw rate are short by the same factor, at all speeds.",
       "Never from poses alone against wheel radius and command gain: those need a surveyed "
       "revolution of the sprocket. A slope or a trailer changes slip, not a radius.",
       "Mark a track shoe, drive ten of its revolutions straight, and tape the distance.",
       {withTotal({"speed over that of the tracks", "1", speedOverTracks},
                  strength("slip", "1", -0.3, 0.7, 0.1, &V::slip_ratio))},
       "Both tracks carry the vehicle further than they turn, by the same share, which is no slip "
       "(check the wheel radius)",
       {{"forward_gain"}, 1},
       "No track slips forwards: check the wheel radius (or sprocket radius, or command gain) that "
       "the track speeds were made with; it may be too small by "},
      {"terrain_change",
       "Change of ground",
       "xw",
       "From a certain moment on the ground is another one: slip and resistance to turning change.",
       "from time_1 of the session on slip_1, width_1 and breakaway_1 are added to slip_ratio, "
       "track_width and yaw_breakaway, from time_2 (if later than time_1) on those with _2 instead",
       "Residuals that belong to a part of the drive: different before and after a moment.",
       "Look where the vehicle was then; drive over the border once more, both ways. A battery or "
       "a hot motor changes gradually, a payload does not depend on the place.",
       "Walk to the place where the change was and look at the ground.",
       {withSigns(strength("width_1", "1", -0.9, 3.0, 0.3, &V::terrain_width_1),
                  "it turns less than before", "it turns more than before"),
        strength("slip_1", "1", -0.5, 0.7, 0.1, &V::terrain_slip_1),
        strength("breakaway_1", "rad/s", -0.5, 0.5, 0.1, &V::terrain_breakaway_1),
        strength("width_2", "1", -0.9, 3.0, 0.3, &V::terrain_width_2),
        strength("slip_2", "1", -0.5, 0.7, 0.1, &V::terrain_slip_2),
        strength("breakaway_2", "rad/s", -0.5, 0.5, 0.1, &V::terrain_breakaway_2),
        shape(strength("time_1", "s", 0.0, 1e6, 300.0, &V::terrain_time_1)),
        shape(strength("time_2", "s", 0.0, 1e6, 600.0, &V::terrain_time_2))},
       "",
       {{},
        0,
        {{"time_1", {"width_1", "slip_1", "breakaway_1"}, 2},
         {"time_2", {"width_2", "slip_2", "breakaway_2"}, 2}}}},
  };
}

std::vector<Effect> turningEffects() {
  using V = EffectValues;
  return {
      only(kOfTracks | kOfOmni,
           {"track_width",
            "Effective track width, steering efficiency",
            "w",
            "The vehicle turns as if its tracks were further apart than they are.",
            "omega -> omega / (1 + widening)",
            "The yaw rate is short by the same factor at all speeds and yaw rates; straight "
            "driving is "
            "right.",
            "Turn on the spot at three rates and in arcs at two speeds: only a width is the same "
            "everywhere.",
            "Turn ten times on the spot and compare with the turns that the tracks' travel gives.",
            {withTotal({"effective width", "m", effectiveWidth},
                       strength("widening", "1", -0.9, 4.0, 0.3, &V::track_width))},
            "The vehicle turns as if its tracks were closer together than they are",
            {{"yaw_gain", "gauge"}, 2}}),
      only(kOfTracks, {"yaw_rate_skid",
                       "Skid that grows with the yaw rate",
                       "w",
                       "The faster it turns, the larger the share of turning that is lost.",
                       "omega -> omega / (1 + skid |omega|)",
                       "The yaw rate residual grows with the square of the yaw rate, against it.",
                       "Three or more yaw rates on the spot: a width loses the same share at each.",
                       "Turn on the spot at a quarter, a half and all of the power and compare the "
                       "shares lost.",
                       {strength("skid", "s", -0.3, 2.0, 0.15, &V::yaw_rate_skid)},
                       "The faster it turns, the further it turns beyond what its tracks ask"}),
      only(kOfTracks,
           {"yaw_breakaway",
            "Break-away of turning, dry friction in yaw",
            "w",
            "Turning begins only above a certain difference of the tracks and lacks it ever after.",
            "omega -> sign(omega) max(0, |omega| - rate)",
            "The yaw rate is short by a constant; gentle turns at speed go straight.",
            "Small differences of the tracks at speed (0.1 to 0.6 m/s): a deadband of the motors "
            "does "
            "not show there, a width loses little.",
            "Drive at half speed and raise the difference of the tracks slowly until it turns.",
            {strength("rate", "rad/s", 0.0, 0.5, 0.1, &V::yaw_breakaway, {0.03, 0.1, 0.2})}}),
      only(
          kOfTracks,
          {"turn_power_limit",
           "Limit of turning power",
           "w",
           "The drive hardly turns the vehicle faster than a certain yaw rate on this ground.",
           "|omega| -> limit + beyond (|omega| - limit) where |omega| > limit; inverse_limit = 1 / "
           "limit",
           "The yaw rate is right up to a value and nearly flat beyond it, on the spot and at "
           "speed; "
           "the forward speed is right.",
           "Turn on the spot with a growing command; a limit of track speed caps the straight "
           "drive, "
           "too, a grip limit does not act on the spot.",
           "Turn on the spot at 60, 80 and 100 % and compare the yaw rates.",
           {inverseLimit("s/rad", 10.0, 0.7, &V::turn_power_limit, {0.25, 0.4, 0.6, 0.9, 1.4},
                         "limit", "rad/s", LimitedQuantity::kYawRate),
            beyond(&V::turn_power_beyond)}}),
  };
}

std::vector<Effect> turningChangeEffects() {
  using V = EffectValues;
  return {
      only(kOfTracks | kOfCars,
           {"speed_understeer",
            "Understeer with speed",
            "w",
            "The same difference of the tracks turns less the faster it drives.",
            "omega -> omega / (1 + gain v^2)",
            "The yaw rate is right on the spot and short at speed.",
            "The same difference of the tracks at three forward speeds.",
            "Drive the same difference of the tracks at walking pace and at full speed.",
            {strength("gain", "s2/m2", -0.1, 2.0, 0.05, &V::speed_understeer)},
            "The same difference of the tracks turns more the faster it drives"}),
      only(kOfTracks | kOfCars,
           {"reverse_yaw_gain",
            "Turning unlike in reverse",
            "w",
            "It turns more willingly in one direction of travel than in the other.",
            "omega -> omega (1 + gain v)",
            "The yaw rate is too large forwards and too small backwards, or the other way round; "
            "right "
            "on the spot.",
            "The same arcs forwards and backwards.",
            "Drive one circle forwards and one backwards.",
            {withSigns(strength("gain", "s/m", -0.5, 0.5, 0.08, &V::reverse_yaw_gain),
                       "it turns more forwards", "it turns more backwards")}}),
      {"payload_change",
       "Change of payload or centre of mass",
       "xyw",
       "From a certain moment on the vehicle carries something else and drives differently.",
       "from time of the session on: omega -> omega (1 + yaw), v -> v (1 + speed), x_icr -> x_icr "
       "+ "
       "icr",
       "A step in the yaw rate residual, perhaps in those of speed and side, at one moment; "
       "everything after it is changed.",
       "Repeat a drive on one surface with and without the load: another ground would be tied to a "
       "place.",
       "Ask who put what on it, and when; weigh front and rear.",
       {withSigns(strength("yaw", "1", -0.8, 1.0, 0.2, &V::payload_yaw),
                  "it turns more than before", "it turns less than before"),
        strength("speed", "1", -0.5, 0.5, 0.05, &V::payload_speed),
        strength("icr", "m", -0.5, 0.5, 0.1, &V::payload_icr),
        shape(strength("time", "s", 0.0, 1e6, 300.0, &V::payload_time))},
       "",
       {{}, 0, {{"time", {"yaw", "speed", "icr"}, 2}}}},
  };
}

std::vector<Effect> gripEffects() {
  using V = EffectValues;
  return {
      only(kOfTracks | kOfCars,
           {"grip_limit",
            "Grip limit, shear failure",
            "w",
            "The ground gives hardly more sideways force than its friction; fast curves get wider.",
            "|omega| -> limit + beyond (|omega| - limit) where |omega| > limit = friction 9.81 "
            "m/s2 / "
            "|v|; inverse_limit = 1 / friction",
            "The yaw rate falls short only where speed times yaw rate is large; on the spot it is "
            "right.",
            "The same yaw rate in a fast wide and in a slow tight turn.",
            "Drive one circle faster and faster until it widens.",
            {inverseLimit("1", 20.0, 4.0, &V::grip_limit, {1.5, 3.0, 6.0, 12.0}, "friction", "1",
                          LimitedQuantity::kLateralAcceleration),
             beyond(&V::grip_beyond)}}),
      only(kOfTracks | kOfOmni,
           {"yaw_pull",
            "Yaw pull",
            "w",
            "It pulls to one side in proportion to its speed.",
            "omega -> omega + pull v",
            "The yaw rate residual is proportional to the forward speed and flips in reverse; the "
            "forward speed in turns is right.",
            "Forwards only it looks like a gyro bias, which is there at standstill, too; a "
            "left-right "
            "asymmetry changes the forward speed in turns, a little.",
            "Drive 20 m straight slowly and fast: a pull misses by the same angle, a bias by more "
            "when "
            "slow.",
            {withSigns(strength("pull", "rad/m", -0.5, 0.5, 0.05, &V::yaw_pull),
                       "it pulls to the left", "it pulls to the right")},
            "",
            inWheels({"left_track_loss", "right_track_loss", "track_asymmetry"})}),
      only(kOfTracks | kOfOmni,
           {"yaw_rate_offset",
            "Constant turning",
            "w",
            "The vehicle turns by itself at a constant rate, whatever the tracks do.",
            "omega -> omega + rate",
            "The same yaw rate residual in all motions; the path is bent accordingly.",
            "Stand still for 30 s: a gyro bias stays without any motion of the vehicle.",
            "Stand still and look whether heading or gyro go on turning.",
            {withSigns(strength("rate", "rad/s", -0.5, 0.5, 0.03, &V::yaw_rate_offset),
                       "it turns to the left", "it turns to the right")},
            "",
            secondName()}),
  };
}

std::vector<Effect> speedLossEffects() {
  using V = EffectValues;
  return {
      only(kOfTracks | kOfCars,
           {"turn_speed_loss",
            "Loss of speed in turns",
            "x",
            "Turning costs forward speed.",
            "v -> v / (1 + loss |omega|)",
            "Too slow in left and right turns alike, right on the straight.",
            "The same mean track speed at several yaw rates.",
            "Time a full circle and a straight of the same length at equal mean command.",
            {strength("loss", "s", -0.5, 2.0, 0.15, &V::turn_speed_loss)},
            "In turns it is faster than its tracks"}),
      only(
          kOfTracks | kOfCars,
          {"reverse_speed_gain",
           "Speed unlike in reverse",
           "x",
           "It is faster in one direction of travel than in the other.",
           "v -> v + gain |v|",
           "Too fast forwards and too slow backwards, or the other way round, in proportion to the "
           "speed.",
           "The same straight forwards and backwards.",
           "Time 10 m forwards and 10 m backwards.",
           {withSigns(strength("gain", "1", -0.5, 0.5, 0.05, &V::reverse_speed_gain),
                      "it is faster forwards", "it is faster backwards")}}),
      {"quadratic_drag",
       "Drag that grows with speed",
       "x",
       "The faster it drives, the larger the share of speed that is lost.",
       "v -> v - drag v |v|",
       "The residual grows with the square of the speed, against it; the yaw rate is right.",
       "Three speeds straight ahead: slip loses the same share at each, rolling resistance the "
       "same speed.",
       "Time 20 m at a third, two thirds and all of full speed.",
       {strength("drag", "s/m", -0.1, 0.5, 0.05, &V::quadratic_drag)},
       "The faster it drives, the further it runs ahead of its tracks"},
      {"rolling_resistance",
       "Rolling resistance, dry friction",
       "x",
       "The vehicle is slower than its tracks by a constant and does not creep at all.",
       "v -> sign(v) max(0, |v| - speed)",
       "Too slow by the same amount at all speeds, forwards and backwards; the yaw rate is right.",
       "Gentle turns: a deadband of the motors changes their yaw rate, rolling resistance does "
       "not.",
       "Raise the command slowly and compare the speed of the tracks with that of the vehicle.",
       {strength("speed", "m/s", 0.0, 0.5, 0.05, &V::rolling_resistance, {0.03, 0.08, 0.15})},
       "",
       inWheels({"motor_deadband"})},
  };
}

}  // namespace tread
