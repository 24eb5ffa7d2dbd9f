// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

namespace tread::launch {

/// A robot that runs on this machine, in the network of the caller.
struct RunningRobot {
  std::string name;  ///< of the launch
  std::string lcm_url;
};

/// Tells the operator's programs of this user about a robot as long as the object lives.
class Announcement {
 public:
  /// Says nothing where the folder for it cannot be used: --lcm-url still finds the robot.
  explicit Announcement(const RunningRobot& robot);
  ~Announcement();
  Announcement(const Announcement&) = delete;
  Announcement& operator=(const Announcement&) = delete;

 private:
  std::string path_;
  int file_ = -1;  ///< locked, so that a killed launch is no robot
};

/// The robots that were announced by this user in this network, and still run.
std::vector<RunningRobot> runningRobots();

/// The URL of the robot to speak to: what was given, else LCM_DEFAULT_URL, else that of the only
/// robot that runs here, else empty, LCM's own. Throws std::runtime_error if several run.
std::string findLcmUrl(const std::string& given);

}  // namespace tread::launch
