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

/// What is wrong with a cable.
struct CableFaults {
  double delay = 0.0;   ///< [s] of each frame
  double jitter = 0.0;  ///< [s] more, at most; frames may overtake each other
  double loss = 0.0;    ///< [1] share of frames that do not arrive
};

/// A cable in this process: carries frames between two network devices (TAP), late and with losses.
/** A kernel without netem can do it, too. */
class BadCable {
 public:
  /// Takes over both devices.
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

/// Two hosts on this machine, joined by a cable: this process moves to a network of its own, the
/// robot's; the other network is the operator's station. LCM's multicast goes over the cable.
class TwoHosts {
 public:
  /// Before anything opens a socket or starts a thread. Throws std::runtime_error where networks of
  /// one's own are not allowed.
  TwoHosts() : TwoHosts(CableFaults{}) {}
  /// With a bad cable, where anything is wrong with it.
  explicit TwoHosts(const CableFaults& faults);
  ~TwoHosts();
  TwoHosts(const TwoHosts&) = delete;
  TwoHosts& operator=(const TwoHosts&) = delete;

  /// Bus of both, of this process alone.
  const std::string& url() const { return url_; }
  /// The words before a program's full path that run it at the station.
  std::vector<std::string> atStation() const;
  /// Pulls the cable, or puts it back.
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
  pid_t station_ = -1;  ///< a process that does nothing but keep the network
  std::unique_ptr<BadCable> bad_cable_;
};

}  // namespace tread::testing
