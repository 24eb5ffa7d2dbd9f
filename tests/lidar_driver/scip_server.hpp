// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <thread>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "common/bus/host_clock.hpp"
#include "modules/simulator/emulators/hokuyo/scip_emulator.hpp"

namespace tread::testing {

/// The emulated range finder behind a real TCP port of this machine.
class ScipServer {
 public:
  enum class Manner {
    kGood,     ///< answers and scans
    kSilent,   ///< accepts, but sends nothing
    kGarbage,  ///< random bytes between the scans
    kCloses,   ///< accepts and closes at once
    kRefuses,  ///< replies to each command with an error, as of SCIP 1.1
    kLazy      ///< replies to the first two clients, sends scans only to later ones
  };

  /// Listens on `port` of the loopback, 0 = any free one.
  explicit ScipServer(Manner manner, int port = 0) : manner_(manner) {
    listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int on = 1;
    setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<uint16_t>(port));
    if (bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
        listen(listener_, 8) != 0)
      return;
    socklen_t size = sizeof address;
    getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~ScipServer() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    close(listener_);
  }

  int port() const { return port_; }
  std::string address() const { return "tcp:127.0.0.1:" + std::to_string(port_); }
  int connections() const { return connections_; }

 private:
  static bool readable(int descriptor, int milliseconds) {
    pollfd ready{descriptor, POLLIN, 0};
    return poll(&ready, 1, milliseconds) > 0;
  }

  void serve() {
    while (!stop_) {
      if (!readable(listener_, 20)) continue;
      const int client = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
      if (client < 0) continue;
      ++connections_;
      const int on = 1;
      setsockopt(client, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
      if (manner_ != Manner::kCloses) talk(client);
      close(client);
    }
  }

  static bool refuse(int client, const std::string& command) {
    const std::string answer = command.substr(0, command.find('\n')) + "\n0E\n\n";
    return send(client, answer.data(), answer.size(), MSG_NOSIGNAL) >= 0;
  }

  void talk(int client) {
    sim::ScipEmulator device(sim::scipSettingsOf(sim::LaserParameters{}), 1);
    sim::ScipFaults faults;
    faults.silent = manner_ == Manner::kSilent;
    faults.garbage = manner_ == Manner::kGarbage;
    device.setFaults(faults);
    int64_t next_scan = hostNow();
    while (!stop_) {
      if (readable(client, 2)) {
        char buffer[512];
        const ssize_t size = read(client, buffer, sizeof buffer);
        if (size <= 0) return;
        if (manner_ == Manner::kRefuses) {
          if (!refuse(client, {buffer, static_cast<size_t>(size)})) return;
          continue;
        }
        device.receive({buffer, static_cast<size_t>(size)}, hostNow());
      }
      const bool scans = manner_ != Manner::kLazy || connections_ > 2;
      if (scans && hostNow() >= next_scan) {
        device.add(scan());
        next_scan += 100'000;
      }
      const std::string answer = device.transmit(hostNow());
      if (!answer.empty() && send(client, answer.data(), answer.size(), MSG_NOSIGNAL) < 0) return;
    }
  }

  /// 3 m to the right, 5 m to the left, no return ahead.
  static sim::LaserScan scan() {
    sim::LaserScan scan;
    scan.utime = hostNow();
    scan.ranges.assign(541, 3.0f);
    for (size_t i = 260; i < 281; ++i) scan.ranges[i] = std::numeric_limits<float>::infinity();
    for (size_t i = 281; i < 541; ++i) scan.ranges[i] = 5.0f;
    return scan;
  }

  Manner manner_;
  int listener_ = -1;
  int port_ = 0;
  std::atomic<int> connections_{0};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace tread::testing
