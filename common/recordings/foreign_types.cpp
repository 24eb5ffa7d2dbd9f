// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/foreign_types.hpp"

namespace tread::recordings {
namespace {

constexpr const char* kForeignTypes = R"lcm(
// Of the same fields, and so the same to a log: odometry_t of the later robots.
struct pose_xyt_t { int64_t utime; float x, y, theta; }

struct odometry_t
{
    int64_t utime;
    float x, y, theta;
    float total_left_distance, total_right_distance;
    float wheelbase;
    float left_wheel_speed, right_wheel_speed;
}

// Also rplidar_laser_t.
struct lidar_t
{
    int64_t utime;
    int32_t num_ranges;
    float   ranges[num_ranges];
    float   thetas[num_ranges];
    int64_t times[num_ranges];
    float   intensities[num_ranges];
}

struct mbot_motor_command_t { int64_t utime; float trans_v, angular_v; }

struct mbot_motor_pwm_t { int64_t utime; float left_motor_pwm, right_motor_pwm; }

struct mbot_wheel_ctrl_t
{
    int64_t utime;
    float left_motor_pwm_cmd, right_motor_pwm_cmd;
    float left_motor_vel_cmd, right_motor_vel_cmd;
    float left_motor_vel, right_motor_vel;
}

struct maebot_motor_command_t
{
    int64_t utime;
    float   left_motor_speed, right_motor_speed;
    boolean left_motor_enabled, right_motor_enabled;
}
)lcm";

}  // namespace

const MessageTypes& foreignTypes() {
  static const MessageTypes types = MessageTypes::fromText(kForeignTypes);
  return types;
}

}  // namespace tread::recordings
