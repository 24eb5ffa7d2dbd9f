// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

namespace tread::launch {

/// A robot that runs on this machine, in the caller's network.
struct RunningRobot {
  std::string name;  ///< of the launch
  std::string lcm_url;
  std::string key;    ///< key file; empty = messages are not sealed
  bool here = false;  ///< found on this machine, so it shares the session and clock
};

/// Announces a robot to this user's operator programs while the object lives.
class Announcement {
 public:
  /// Does nothing if the folder for it cannot be used: --lcm-url still finds the robot.
  explicit Announcement(const RunningRobot& robot);
  ~Announcement();
  Announcement(const Announcement&) = delete;
  Announcement& operator=(const Announcement&) = delete;

 private:
  std::string path_;
  int file_ = -1;  ///< locked, so that a killed launch does not count as running
};

/// Robots that this user announced in this network and that still run.
std::vector<RunningRobot> runningRobots();

/// Finds the robot and its key. URL: the one given, else LCM_DEFAULT_URL, else that of the only
/// running robot; an empty URL is LCM's default. Key: the one given, else that of the running robot
/// at this URL. Throws std::runtime_error if several robots run.
RunningRobot findRobot(const std::string& lcm_url, const std::string& key);

}  // namespace tread::launch
