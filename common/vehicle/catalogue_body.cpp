// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Inertia, motion to the side, slopes; what the INS makes of the motion; what is confounded.
#include "common/vehicle/catalogue_body.hpp"

#include "common/vehicle/catalogue_parts.hpp"

namespace tread {

std::vector<Effect> inertiaEffects() {
  using V = EffectValues;
  return {
      {"yaw_inertia",
       "Yaw inertia, yaw lag",
       "w",
       "The body goes on turning as it did before and takes up a new yaw rate gradually.",
       "omega' = (omega_steady - omega) / lag",
       "After a change the yaw rate residual points to what was before; the speed is right.",
       "Change between turns at constant mean speed, and the speed without turning: a lag of the "
       "drive shows in both.",
       "Stop a turn on the spot at once and see how far it goes on.",
       {strength("lag", "s", 0.0, 3.0, 0.3, &V::yaw_inertia)},
       "",
       isLate(LateBy::kYawRate)},
      {"body_inertia",
       "Body inertia, momentum",
       "x",
       "The body slides on as it drove before and takes up a new speed gradually.",
       "v' = (v_steady - v) / lag",
       "After a change the residual along the track points to what was before; the yaw rate is "
       "right.",
       "Speed steps straight ahead against turn steps at constant speed: a lag of the drive shows "
       "in both.",
       "Stop from full speed and measure how far the body slides over standing tracks.",
       {strength("lag", "s", 0.0, 3.0, 0.2, &V::body_inertia)},
       "",
       isLate(LateBy::kSpeed)},
      {"icr_offset",
       "Centre of rotation ahead of or behind the middle",
       "y",
       "The vehicle turns about a point ahead of (positive) or behind its middle, so that turning "
       "moves its middle sideways.",
       "v_y -> v_y - offset omega",
       "The lateral residual is proportional to the yaw rate, on the spot, too.",
       "Measure the lever arm with a tape: poses alone cannot tell. A centre of rotation moves "
       "with ground and payload, a lever arm never.",
       "Turn on the spot, mark the point of the hull that stays, tape its distance to the middle.",
       {upToGauges(1.5, withSigns(strength("offset", "m", -0.5, 0.5, 0.1, &V::icr_offset),
                                  "ahead of the middle", "behind the middle"))}},
      {"crab",
       "Crabbing",
       "y",
       "The vehicle drifts to one side of its heading as it drives (toe of the tracks).",
       "v_y -> v_y + v tan(angle)",
       "The lateral residual is proportional to the speed and flips in reverse.",
       "Sight along the hull: an INS that is mounted askew looks the same. Drive the same line "
       "both "
       "ways: a slope to the side flips in the body, crabbing does not.",
       "Drive straight along a chalk line and compare the hull's direction with it.",
       {withSigns(strength("angle", "rad", -0.5, 0.5, 0.05, &V::crab), "it drifts to the left",
                  "it drifts to the right")},
       "",
       secondName()},
  };
}

std::vector<Effect> sideEffects() {
  using V = EffectValues;
  return {
      only(
          kOfTracks | kOfCars,
          {"centrifugal_drift",
           "Centrifugal drift",
           "y",
           "In curves it is carried outwards, more the faster and tighter.",
           "v_y -> v_y - time v omega",
           "The lateral residual is proportional to speed times yaw rate, outwards; nothing on the "
           "spot.",
           "Another surface: drift changes with the grip, a latency of the heading is the same "
           "everywhere.",
           "Drive the same circle slowly and fast and compare the angle between heading and path.",
           {strength("time", "s", -0.5, 1.0, 0.15, &V::centrifugal_drift)},
           "In curves it is carried inwards, more the faster and tighter"}),
      {"slope_pitch",
       "Slope along the track",
       "x",
       "It is slower uphill and faster downhill.",
       "v -> v - compliance 9.81 m/s2 sin(climb), climb = -pitch; fades out below 0.05 m/s of the "
       "tracks",
       "The residual along the track follows the slope and not the command.",
       "Up and down the same slope: a battery or the ground do not flip.",
       "Time 10 m up and 10 m down the same slope.",
       {strength("compliance", "s", -0.1, 0.5, 0.05, &V::slope_pitch)},
       "It is faster uphill and slower downhill"},
      {"slope_roll",
       "Slope across the track",
       "y",
       "Driving across a slope it slides downhill.",
       "v_y -> v_y - compliance 9.81 m/s2 sin(roll); fades out below 0.05 m/s of the tracks",
       "The lateral residual follows the roll angle.",
       "Traverse the slope in both directions: sliding flips in the body, a misaligned heading "
       "does not.",
       "Traverse a slope along a string and measure the miss, then back.",
       {strength("compliance", "s", -0.1, 0.5, 0.05, &V::slope_roll)},
       "Driving across a slope it climbs"},
  };
}

std::vector<Effect> timingEffects() {
  using M = MeasurementModel;
  return {
      {"ins_latency",
       "INS latency, clock offset",
       "xyw",
       "The INS says where the vehicle was a while ago.",
       "pose(t) -> pose(t - latency), yaw rate(t) -> yaw rate(t - gyro_share latency)",
       "Residuals wherever the motion changes; heading and integrated gyro are out of step.",
       "Correlate heading and gyro; hardware time stamps or a pulse per second. If the gyro is as "
       "late as the pose it cannot be told from a delay of the commands.",
       "Turn the vehicle to and fro; compare the moments at which heading and gyro reverse.",
       {strength("latency", "s", -1.0, 2.0, 0.2, &M::ins_latency),
        shape(strength("gyro_share", "1", 0.0, 1.0, 0.0, &M::ins_latency_gyro), {0.0, 1.0})},
       "The stamps of the INS are early: its poses belong to later moments",
       isLate(LateBy::kPoses, {{}, 5})},
      {"heading_latency",
       "Heading late against position",
       "yw",
       "The heading of a pose is older than its position.",
       "heading(t) -> heading(t - latency), position as it is",
       "The lateral residual is proportional to speed times yaw rate: like a drift inwards for a "
       "late heading, outwards for a late position (negative).",
       "Another surface: a latency is the same everywhere, a drift changes with the grip.",
       "Drive a tight circle on tarmac and on grass and compare.",
       {strength("latency", "s", -0.5, 0.5, 0.1, &M::heading_latency)},
       "The position of a pose is older than its heading"},
      {"position_scale",
       "Scale of positions",
       "xy",
       "Distances of the INS are too long or too short by a share (wrong datum, odometer scale).",
       "p -> (1 + scale) p",
       "The residual along the track is proportional to the speed; headings are right.",
       "A surveyed distance. From poses alone it is slip and track width together.",
       "Drive between two surveyed marks and compare.",
       {withSigns(strength("scale", "1", -0.2, 0.2, 0.02, &M::position_scale), "too long",
                  "too short")},
       "",
       secondNameOf(kOfOmni)},
  };
}

std::vector<Effect> mountingEffects() {
  using M = MeasurementModel;
  return {
      {"lever_arm_x",
       "Lever arm along the vehicle",
       "y",
       "The INS reports a point that is so far behind the vehicle's middle (configured lever arm "
       "less the true one).",
       "p -> p - R(yaw) (offset, 0): v_y -> v_y - offset omega",
       "The lateral residual is proportional to the yaw rate, on the spot, too.",
       "Measure the lever arm with a tape; a centre of rotation moves with ground and payload.",
       "Tape the distance from antenna to middle and compare with the INS configuration.",
       {upToGauges(1.5, strength("offset", "m", -1.0, 1.0, 0.1, &M::lever_arm_x))},
       "The INS reports a point that is so far ahead of the vehicle's middle"},
      {"lever_arm_y",
       "Lever arm across the vehicle",
       "x",
       "The INS reports a point that is so far to the right of the vehicle's middle (configured "
       "lever arm less the true one).",
       "p -> p - R(yaw) (0, offset): v_x -> v_x + offset omega",
       "The residual along the track is proportional to the yaw rate, odd: too fast in one turn, "
       "too slow in the other.",
       "Measure the lever arm with a tape; turn on the spot both ways.",
       "Tape the distance from antenna to the middle line and compare.",
       {upToGauges(0.75, strength("offset", "m", -1.0, 1.0, 0.1, &M::lever_arm_y))},
       "The INS reports a point that is so far to the left of the vehicle's middle"},
      {"heading_misalignment",
       "INS mounted askew",
       "y",
       "The INS's heading is turned against the vehicle's by a constant.",
       "heading -> heading - angle: v_y -> v_y + angle v",
       "The lateral residual is proportional to the speed and flips in reverse.",
       "Turn the vehicle round on the same line: a slope flips in the body, misalignment stays.",
       "Drive straight along a chalk line and compare the INS heading with its direction.",
       {withSigns(strength("angle", "rad", -0.3, 0.3, 0.04, &M::heading_misalignment),
                  "its heading points too far to the right",
                  "its heading points too far to the left")}},
      {"gyro_bias",
       "Gyro bias, heading drift",
       "w",
       "The gyro reports a turn that is not there.",
       "omega -> omega + rate; heading -> heading + heading_share rate T",
       "A constant yaw rate residual, at standstill, too.",
       "Standing still for 30 s at start and end.",
       "Stand still for 30 s and read the yaw rate.",
       {withSigns(strength("rate", "rad/s", -0.2, 0.2, 0.02, &M::gyro_bias), "a turn to the left",
                  "a turn to the right"),
        shape(strength("heading_share", "1", 0.0, 1.0, 0.0, &M::gyro_bias_heading), {0.0, 1.0})}},
  };
}

std::vector<ConfoundedGroup> groupsOfEveryDrive() {
  return {
      {"ground_speed",
       {"slip_ratio", "forward_gain", "full_speed"},
       "",
       "1 - slip is a factor on the speed of both tracks, as wheel radius and command gain are "
       "(forward_gain and yaw_gain together)",
       "Turn the sprocket by hand once round and measure its travel; drive on a slope: slip "
       "changes, a radius does not.",
       true},
      {"body_point",
       {"icr_offset", "lever_arm_x"},
       "",
       "v_y = -offset omega in both",
       "Measure the lever arm with a tape.",
       true},
      {"turn_and_speed",
       {"centrifugal_drift", "heading_latency"},
       "",
       "v_y in proportion to v omega in both, to first order of the angle omega latency; a drift "
       "of "
       "time is a latency of -time",
       "Drive on another surface: a latency stays.",
       true},
      {"late",
       {"command_delay", "ins_latency"},
       "position and gyro equally late (gyro_share 1)",
       "everything happens later by the same time",
       "Wheel encoders, motor current or hardware time stamps.",
       true,
       &MeasurementModel::ins_latency_gyro,
       " of poses and gyro alike"},
      {"translation",
       {"translation_loss", "position_scale"},
       "",
       "of a holonomic base a loss is a scale of -loss",
       "Drive a surveyed distance; on another ground a scale stays.",
       true},
      {"scale",
       {"position_scale", "slip_ratio", "track_width"},
       "",
       "a scale k is slip -k and widening k together, where nothing moves the vehicle sideways",
       "Drive a surveyed distance."},
      {"direction_of_travel",
       {"crab", "heading_misalignment"},
       "",
       "v_y = v tan(angle) in both, to first order of the angle",
       "Sight along the hull; drive along a chalk line.",
       true},
      {"payload_or_ground",
       {"payload_change", "terrain_change"},
       "one change at one moment",
       "a factor on the yaw rate from one moment on in both",
       "Drive the same ground once more with and without the load.",
       true},
  };
}

std::vector<ConfoundedGroup> groupsOfPoorDrives() {
  return {
      {"one_speed",
       {"slip_ratio", "motor_deadband", "rolling_resistance", "quadratic_drag"},
       "straight driving at one constant speed",
       "one residual along the track cannot tell which of them it is",
       "Three speeds, forwards and backwards, and gentle turns."},
      {"one_yaw_rate",
       {"track_width", "yaw_rate_skid", "yaw_breakaway", "speed_understeer"},
       "turns of one yaw rate at one speed",
       "one yaw rate residual cannot tell which of them it is",
       "Turns on the spot at three rates and arcs at three speeds."},
      {"late_position",
       {"body_inertia", "ins_latency", "centrifugal_drift", "heading_latency"},
       "",
       "a position that is late by itself (INS latency t, heading latency -t) is what a body gives "
       "that takes up its speed late and drifts outwards in curves, to first order of the time",
       "Stop from full speed straight ahead and on the spot: a body slides on and comes to rest "
       "gradually, a late position comes to rest as the drive does, but later.",
       false,
       nullptr,
       "",
       true},
      {"forwards_only",
       {"track_asymmetry", "yaw_pull", "yaw_rate_offset", "gyro_bias"},
       "forward driving at one speed",
       "a constant yaw rate residual in all of them",
       "Drive in reverse, at two speeds, and stand still for 30 s."},
  };
}

}  // namespace tread
