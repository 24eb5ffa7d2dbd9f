// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace tread::testing {

/// Two hosts on this machine, joined by a cable: this process moves to a network of its own, the
/// robot's; the other network is the operator's station. LCM's multicast goes over the cable.
class TwoHosts {
 public:
  /// Before anything opens a socket or starts a thread. Throws std::runtime_error where networks of
  /// one's own are not allowed.
  TwoHosts();
  ~TwoHosts();
  TwoHosts(const TwoHosts&) = delete;
  TwoHosts& operator=(const TwoHosts&) = delete;

  /// Bus of both, of this process alone.
  const std::string& url() const { return url_; }
  /// The words before a program's full path that run it at the station.
  std::vector<std::string> atStation() const;
  /// Pulls the cable, or puts it back.
  void plug(bool in) const;
  /// A UDP socket at the station.
  int stationSocket() const;

  static constexpr const char* kRobot = "10.77.0.1";
  static constexpr const char* kStation = "10.77.0.2";

 private:
  void joinHosts() const;
  std::string network() const { return "/proc/" + std::to_string(station_) + "/ns/net"; }

  std::string url_;
  pid_t station_ = -1;  ///< a process that does nothing but keep the network
};

}  // namespace tread::testing
