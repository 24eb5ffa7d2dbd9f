// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include <sys/types.h>

#include <memory>

namespace tread::testing {

/// Faults of a cable.
struct CableFaults {
  double delay = 0.0;   ///< [s] per frame
  double jitter = 0.0;  ///< [s] additional, at most; frames may overtake each other
  double loss = 0.0;    ///< [1] share of lost frames
};

/// A cable in this process: passes frames between two network devices (TAP), with delay and losses.
/** It works also on a kernel without netem. */
class BadCable {
 public:
  /// Takes ownership of both devices.
  BadCable(int robot, int station, const CableFaults& faults);
  ~BadCable();
  BadCable(const BadCable&) = delete;
  BadCable& operator=(const BadCable&) = delete;
  void plug(bool in) { plugged_ = in; }

 private:
  void carry();

  int ends_[2];
  CableFaults faults_;
  std::atomic<bool> plugged_{true};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// Two hosts on this machine, connected by a cable: this process moves to a separate network, the
/// robot's; the other network is the operator station's. LCM's multicast uses the cable.
class TwoHosts {
 public:
  /// Call before opening sockets or starting threads. Throws std::runtime_error if separate
  /// networks are not permitted.
  TwoHosts() : TwoHosts(CableFaults{}) {}
  /// With a faulty cable.
  explicit TwoHosts(const CableFaults& faults);
  ~TwoHosts();
  TwoHosts(const TwoHosts&) = delete;
  TwoHosts& operator=(const TwoHosts&) = delete;

  /// Bus of both hosts, for this process only.
  const std::string& url() const { return url_; }
  /// Prefix for a program's full path that runs it at the station.
  std::vector<std::string> atStation() const;
  /// Disconnects or reconnects the cable.
  void plug(bool in);
  /// A UDP socket at the station.
  int stationSocket() const;

  static constexpr const char* kRobot = "10.77.0.1";
  static constexpr const char* kStation = "10.77.0.2";

 private:
  void joinHosts(const CableFaults& faults);
  template <class Make>
  int there(const Make& make) const;
  std::string network() const { return "/proc/" + std::to_string(station_) + "/ns/net"; }

  std::string url_;
  pid_t station_ = -1;  ///< an idle process that keeps the network
  std::unique_ptr<BadCable> bad_cable_;
};

}  // namespace tread::testing
