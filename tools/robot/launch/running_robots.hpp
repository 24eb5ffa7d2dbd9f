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
  std::string key;    ///< file; empty = messages are not sealed
  bool here = false;  ///< it was found on this machine, whose session and clock are its own
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

/// The robot to speak to, and its key: at the URL that was given, else at LCM_DEFAULT_URL, else the
/// only robot that runs here; with the key that was given, else what a robot that runs here at this
/// URL was started with. An empty URL is LCM's own. Throws std::runtime_error if several robots
/// run.
RunningRobot findRobot(const std::string& lcm_url, const std::string& key);

}  // namespace tread::launch
