// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <thread>

namespace tread {

/// Server of LCM's transport tcpq, for hosts without multicast: passes each message on to all
/// subscribers of its channel.
/** Runs in its own thread and listens on 127.0.0.1 only. LCM's Java server does the same, but
 * leaves Nagle's algorithm on (up to 40 ms a hop) and waits for the slowest receiver; here a
 * receiver that does not read loses messages, as with UDP. */
class TcpRelay {
 public:
  /// Port 0 takes any free one. Throws std::runtime_error, one line, if the port cannot be used.
  explicit TcpRelay(uint16_t port);
  ~TcpRelay();
  TcpRelay(const TcpRelay&) = delete;
  TcpRelay& operator=(const TcpRelay&) = delete;

  /// The LCM URL of this bus.
  std::string url() const;

 private:
  int listener_ = -1;
  int stop_ = -1;  ///< an eventfd: readable = end the thread
  uint16_t port_ = 0;
  std::thread thread_;
};

}  // namespace tread
