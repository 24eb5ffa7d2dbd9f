// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/overlay/logged_drive.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>

#include <tread/ins_t.hpp>
#include <tread/motor_t.hpp>

#include "common/log/event_log.hpp"
#include "common/messages/ins_messages.hpp"

namespace tread::overlay {
namespace {

/// Collects the two channels with the device times they carry.
class Collector {
 public:
  void take(const motor_t& motor) {
    if (!begin_) begin_ = motor.utime;
    if (motor.motor_command_kind != 0) {
      drive_.kind = static_cast<CommandKind>(motor.motor_command_kind);
      driven_ = true;
    }
    const auto voltage = static_cast<double>(motor.battery_voltage);
    if (full_voltage_ == 0.0 && std::isfinite(voltage)) full_voltage_ = voltage;
    GivenCommand given;
    given.time = seconds(motor.utime);
    given.command = {static_cast<double>(motor.command_left),
                     static_cast<double>(motor.command_right)};
    if (full_voltage_ > 0.0 && std::isfinite(voltage))
      given.battery_drop = 1.0 - voltage / full_voltage_;
    drive_.commands.push_back(given);
  }

  void take(const ins_t& ins) {
    const std::optional<Pose2> T_map_body = planarPose(ins);
    if (!begin_ || !T_map_body) return;
    MeasuredPose measured;
    measured.time = seconds(ins.utime);
    measured.T_map_body = *T_map_body;
    if (!drive_.track.empty()) {
      const double last = drive_.track.back().T_map_body.yaw;
      measured.T_map_body.yaw = last + wrapAngle(T_map_body->yaw - last);
    }
    if (const auto T = spatialPose(ins)) {
      const YawPitchRoll angles = yawPitchRoll(Eigen::Quaterniond(T->linear()));
      measured.roll = angles.roll;
      measured.pitch = angles.pitch;
    }
    drive_.track.push_back(measured);
  }

  const LoggedDrive& drive() const { return drive_; }
  bool driven() const { return driven_; }

 private:
  double seconds(int64_t utime) const { return 1e-6 * static_cast<double>(utime - *begin_); }

  LoggedDrive drive_;
  std::optional<int64_t> begin_;
  double full_voltage_ = 0.0;
  bool driven_ = false;
};

}  // namespace

LoggedDrive readLoggedDrive(const std::vector<std::string>& logs) {
  Collector collector;
  for (const std::string& path : logs) {
    LogReader reader(path);
    LogEvent event;
    motor_t motor;
    ins_t ins;
    while (reader.next(event)) {
      if (decode(event, kMotor, motor)) collector.take(motor);
      if (decode(event, kIns, ins)) collector.take(ins);
    }
  }
  const LoggedDrive& drive = collector.drive();
  for (const auto& [channel, empty] :
       {std::pair{"MOTOR", drive.commands.empty()}, std::pair{"INS", drive.track.empty()}})
    if (empty)
      throw std::runtime_error(logs.front() + ": holds no " + channel +
                               "; a log of a drive has MOTOR and INS");
  if (!collector.driven()) throw std::runtime_error(logs.front() + ": nothing was driven in it");
  return drive;
}

}  // namespace tread::overlay
