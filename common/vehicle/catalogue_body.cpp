// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/catalogue_parts.hpp"

namespace tread {

std::vector<Effect> bodyEffects() {
  using V = EffectValues;
  return {
      {"yaw_inertia",
       "Yaw inertia, yaw lag",
       EffectKind::kVehicle,
       "w",
       "The body goes on turning as it did before and takes up a new yaw rate gradually.",
       "omega' = (omega_steady - omega) / lag",
       "After a change the yaw rate residual points to what was before; the speed is right.",
       "Change between turns at constant mean speed, and the speed without turning: a lag of the "
       "drive shows in both.",
       "Stop a turn on the spot at once and see how far it goes on.",
       {strength("lag", "s", 0.0, 3.0, 0.3, &V::yaw_inertia)}},
      {"body_inertia",
       "Body inertia, momentum",
       EffectKind::kVehicle,
       "x",
       "The body slides on as it drove before and takes up a new speed gradually.",
       "v' = (v_steady - v) / lag",
       "After a change the residual along the track points to what was before; the yaw rate is "
       "right.",
       "Speed steps straight ahead against turn steps at constant speed: a lag of the drive shows "
       "in both.",
       "Stop from full speed and measure how far the body slides over standing tracks.",
       {strength("lag", "s", 0.0, 3.0, 0.2, &V::body_inertia)}},
      {"icr_offset",
       "Centre of rotation ahead of or behind the middle",
       EffectKind::kVehicle,
       "y",
       "The vehicle turns about a point ahead of (positive) or behind its middle, so that turning "
       "moves its middle sideways.",
       "v_y -> v_y - offset omega",
       "The lateral residual is proportional to the yaw rate, on the spot, too.",
       "Measure the lever arm with a tape: poses alone cannot tell. A centre of rotation moves "
       "with ground and payload, a lever arm never.",
       "Turn on the spot, mark the point of the hull that stays, tape its distance to the middle.",
       {strength("offset", "m", -0.5, 0.5, 0.1, &V::icr_offset)}},
      {"crab",
       "Crabbing",
       EffectKind::kVehicle,
       "y",
       "The vehicle drifts to one side of its heading as it drives (toe of the tracks).",
       "v_y -> v_y + v tan(angle)",
       "The lateral residual is proportional to the speed and flips in reverse.",
       "Sight along the hull: an INS that is mounted askew looks the same. Drive the same line "
       "both "
       "ways: a slope to the side flips in the body, crabbing does not.",
       "Drive straight along a chalk line and compare the hull's direction with it.",
       {strength("angle", "rad", -0.5, 0.5, 0.05, &V::crab)}},
      {"centrifugal_drift",
       "Centrifugal drift",
       EffectKind::kVehicle,
       "y",
       "In curves it is carried outwards, more the faster and tighter.",
       "v_y -> v_y - time v omega",
       "The lateral residual is proportional to speed times yaw rate, outwards; nothing on the "
       "spot.",
       "Another surface: drift changes with the grip, a latency of the heading is the same "
       "everywhere.",
       "Drive the same circle slowly and fast and compare the angle between heading and path.",
       {strength("time", "s", -0.5, 1.0, 0.15, &V::centrifugal_drift)}},
      {"slope_pitch",
       "Slope along the track",
       EffectKind::kVehicle,
       "x",
       "It is slower uphill and faster downhill.",
       "v -> v - compliance 9.81 m/s2 sin(climb), climb = -pitch; fades out below 0.05 m/s of the "
       "tracks",
       "The residual along the track follows the slope and not the command.",
       "Up and down the same slope: a battery or the ground do not flip.",
       "Time 10 m up and 10 m down the same slope.",
       {strength("compliance", "s", -0.1, 0.5, 0.05, &V::slope_pitch)}},
      {"slope_roll",
       "Slope across the track",
       EffectKind::kVehicle,
       "y",
       "Driving across a slope it slides downhill.",
       "v_y -> v_y - compliance 9.81 m/s2 sin(roll); fades out below 0.05 m/s of the tracks",
       "The lateral residual follows the roll angle.",
       "Traverse the slope in both directions: sliding flips in the body, a misaligned heading "
       "does not.",
       "Traverse a slope along a string and measure the miss, then back.",
       {strength("compliance", "s", -0.1, 0.5, 0.05, &V::slope_roll)}},
  };
}

}  // namespace tread
