// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "tools/robot/setup/site.hpp"

namespace tread::setup {

/// Options for this host.
struct HostOptions {
  std::vector<std::string> ports;  ///< the only ones to look at; empty: all of this host
  std::string launch_folder;       ///< with robot.yaml and recording.yaml
  std::string run;                 ///< folder for states and logs
  std::string lcm_url;             ///< empty = the launch files'
};

/// Serial lines (by their persistent names), CAN interfaces, Velodyne's UDP port, and SICK's TCP
/// port on neighbouring hosts.
std::vector<std::string> portsOfHost();

/// This host: real ports, real time, and tread-launch for the processes.
class HostSite : public Site {
 public:
  /// Once `interrupted` is true, waiting throws std::runtime_error, and destructors stop the
  /// motors.
  HostSite(HostOptions options, const std::atomic<bool>& interrupted);

  std::vector<std::string> ports() override { return ports_; }
  std::unique_ptr<Link> open(const std::string& address) override;
  int64_t now() override;
  void pass(int64_t duration) override;
  std::unique_ptr<RobotSession> start(const std::string& folder, Processes which) override;

 private:
  HostOptions options_;
  const std::atomic<bool>& interrupted_;
  std::vector<std::string> ports_;
};

}  // namespace tread::setup
