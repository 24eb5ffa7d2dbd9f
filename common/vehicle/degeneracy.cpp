// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/degeneracy.hpp"

#include <algorithm>

namespace tread {
namespace {

std::vector<DegeneracyGroup> alwaysTheSame() {
  return {
      {"ground_speed",
       {"slip_ratio", "forward_gain", "full_speed"},
       "",
       "1 - slip is a factor on the speed of both tracks, as wheel radius and command gain are "
       "(forward_gain and yaw_gain together)",
       "Turn the sprocket by hand once round and measure its travel; drive on a slope: slip "
       "changes, a radius does not."},
      {"body_point",
       {"icr_offset", "lever_arm_x"},
       "",
       "v_y = -offset omega in both",
       "Measure the lever arm with a tape."},
      {"turn_and_speed",
       {"centrifugal_drift", "heading_latency"},
       "",
       "v_y in proportion to v omega in both, to first order of the angle omega latency; a drift "
       "of "
       "time is a latency of -time",
       "Drive on another surface: a latency stays."},
      {"late",
       {"command_delay", "ins_latency"},
       "position and gyro equally late (gyro_share 1)",
       "everything happens later by the same time",
       "Wheel encoders, motor current or hardware time stamps."},
      {"scale",
       {"position_scale", "slip_ratio", "track_width"},
       "",
       "a scale k is slip -k and widening k together, where nothing moves the vehicle sideways",
       "Drive a surveyed distance."},
      {"direction_of_travel",
       {"crab", "heading_misalignment"},
       "",
       "v_y = v tan(angle) in both, to first order of the angle",
       "Sight along the hull; drive along a chalk line."},
      {"payload_or_ground",
       {"payload_change", "terrain_change"},
       "one change at one moment",
       "a factor on the yaw rate from one moment on in both",
       "Drive the same ground once more with and without the load."},
  };
}

std::vector<DegeneracyGroup> poorDrives() {
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
      {"forwards_only",
       {"track_asymmetry", "yaw_pull", "yaw_rate_offset", "gyro_bias"},
       "forward driving at one speed",
       "a constant yaw rate residual in all of them",
       "Drive in reverse, at two speeds, and stand still for 30 s."},
  };
}

}  // namespace

const std::vector<DegeneracyGroup>& degeneracyGroups() {
  static const std::vector<DegeneracyGroup> groups = [] {
    std::vector<DegeneracyGroup> all = alwaysTheSame();
    for (DegeneracyGroup& group : poorDrives()) all.push_back(std::move(group));
    return all;
  }();
  return groups;
}

std::vector<const DegeneracyGroup*> groupsOf(const std::string& effect) {
  std::vector<const DegeneracyGroup*> found;
  for (const DegeneracyGroup& group : degeneracyGroups())
    if (std::find(group.members.begin(), group.members.end(), effect) != group.members.end())
      found.push_back(&group);
  return found;
}

}  // namespace tread
