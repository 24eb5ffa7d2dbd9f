// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/robot/setup/robot_folder.hpp"
#include "tools/robot/setup/site.hpp"

namespace tread::setup {

/// INS and motors of a robot without its processes, for short drives before those can run.
/** It detects no obstacles. Its destructor gives the motors zero. */
class DirectRobot {
 public:
  /// Opens both ports; throws std::runtime_error, one line, if one cannot be opened.
  DirectRobot(Site& site, const Drivers& drivers);
  ~DirectRobot();
  DirectRobot(const DirectRobot&) = delete;
  DirectRobot& operator=(const DirectRobot&) = delete;

  /// The command for each 50 ms as shares of the full one; nullopt = send nothing.
  using Choose = std::function<std::optional<TrackCommand>(int64_t utime)>;
  /// Drives for `seconds` or until the controller reports a fault; returns that in one line, else
  /// empty.
  std::string run(double seconds, const Choose& choose, const std::function<bool()>& ended = {});
  /// Waits for controller and INS; returns what is missing, one line; empty = ready.
  std::string begin();

  const std::vector<TimedCommand>& commands() const { return commands_; }
  const std::vector<TimedPose>& fixes() const { return fixes_; }
  /// [rad] at the INS's newest fix.
  const YawPitchRoll& attitude() const { return attitude_; }
  /// A pose newer than the last call, if any.
  std::optional<Pose2> takePose();
  motor::MotorTelemetry telemetry() const { return controller_->telemetry(); }
  int64_t now() { return site_.now(); }

 private:
  void exchange();
  /// Fault that the controller reports, one line; empty = none.
  std::string fault() const;

  Site& site_;
  double full_command_, full_second_;  ///< of left and right, or of throttle and steering
  std::unique_ptr<Link> motor_link_, ins_link_;
  std::unique_ptr<motor::MotorController> controller_;
  std::unique_ptr<ins::InsSource> ins_;
  std::vector<TimedCommand> commands_;
  std::vector<TimedPose> fixes_;
  YawPitchRoll attitude_;
  bool silent_ = false;  ///< send nothing
  size_t taken_ = 0;     ///< fixes that takePose() has returned
};

}  // namespace tread::setup
