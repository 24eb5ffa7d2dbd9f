// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/overlay/logged_drive.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>

#include "common/log/drive_log.hpp"
#include "common/messages/ins_messages.hpp"

namespace tread::overlay {
namespace {

double secondsBetween(int64_t from, int64_t to) {
  return 1e-6 * static_cast<double>(to - from);
}

std::vector<GivenCommand> commandsOf(const DriveLog& log) {
  std::vector<GivenCommand> commands;
  double full_voltage = 0.0;
  for (const motor_t& motor : log.motor) {
    const auto voltage = static_cast<double>(motor.battery_voltage);
    if (full_voltage == 0.0 && std::isfinite(voltage)) full_voltage = voltage;
    GivenCommand given;
    given.time = secondsBetween(log.motor.front().utime, motor.utime);
    given.command = {static_cast<double>(motor.command_left),
                     static_cast<double>(motor.command_right)};
    if (full_voltage > 0.0 && std::isfinite(voltage))
      given.battery_drop = 1.0 - voltage / full_voltage;
    commands.push_back(given);
  }
  return commands;
}

/// The poses since the first MOTOR message.
std::vector<MeasuredPose> trackOf(const DriveLog& log) {
  std::vector<MeasuredPose> track;
  if (log.motor.empty()) return track;
  const int64_t begin = log.motor.front().utime;
  for (const ins_t& ins : log.ins) {
    const std::optional<Pose2> T_map_body = planarPose(ins);
    if (!T_map_body || ins.utime < begin) continue;
    MeasuredPose measured;
    measured.time = secondsBetween(begin, ins.utime);
    measured.T_map_body = *T_map_body;
    if (!track.empty()) {
      const double last = track.back().T_map_body.yaw;
      measured.T_map_body.yaw = last + wrapAngle(T_map_body->yaw - last);
    }
    if (const auto T = spatialPose(ins)) {
      const YawPitchRoll angles = yawPitchRoll(Eigen::Quaterniond(T->linear()));
      measured.roll = angles.roll;
      measured.pitch = angles.pitch;
    }
    track.push_back(measured);
  }
  return track;
}

}  // namespace

LoggedDrive readLoggedDrive(const std::vector<std::string>& logs) {
  const DriveLog log = readDriveLog(logs);
  LoggedDrive drive{CommandKind::kPower, commandsOf(log), trackOf(log)};
  for (const auto& [channel, empty] :
       {std::pair{"MOTOR", drive.commands.empty()}, std::pair{"INS", drive.track.empty()}})
    if (empty)
      throw std::runtime_error(logs.front() + ": holds no " + channel +
                               "; a log of a drive has MOTOR and INS");
  int16_t kind = 0;
  for (const motor_t& motor : log.motor)
    if (motor.motor_command_kind != 0) kind = motor.motor_command_kind;
  if (kind == 0) throw std::runtime_error(logs.front() + ": nothing was driven in it");
  drive.kind = static_cast<CommandKind>(kind);
  return drive;
}

}  // namespace tread::overlay
