// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "tools/robot/view/feed/feed.hpp"
#include "tools/robot/view/feed/protocol.hpp"
#include "tools/robot/view/sockets.hpp"

namespace tread::view {

/// Serves the page by HTTP and the feed by WebSocket (the Foxglove protocol).
/** One thread: step() does everything. A slow viewer gets only the newest of each part and never
 * delays the others. The cost of all viewers is limited: places, requests, bytes. */
class ViewServer {
 public:
  /// `command`: from a page, with its number; returns the error, empty = accepted.
  using Command = std::function<std::string(const std::string& json, uint64_t page)>;
  using Leave = std::function<void(uint64_t page)>;

  /// Throws std::runtime_error with one clear line if the address cannot be used.
  ViewServer(const ServerSettings& settings, Command command, Leave leave);
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  Feed& feed() { return feed_; }
  /// Serves what is due without waiting. `elapsed` [s] since the last call.
  void step(double elapsed);
  /// Shows a status line on all pages; the newest replaces the others.
  void tell(const std::string& words);
  /// The page that holds the robot; 0 = none. It is served first.
  void setOperator(uint64_t page) { operator_ = page; }
  int port() const { return sockets_.port(); }

 private:
  bool wanted(uint32_t channel) const;
  void send(const FeedMessage& message);
  void greet(Client& client);
  std::pair<std::string, bool> bytesOf(const Client& client, const Frame& frame);
  void receive(Client& client, const std::string& text, bool binary);
  void serve(Client& client, const ClientRequest& request);
  void control(Client& client, const std::string& topic, const std::string& payload);

  Command command_;
  Leave leave_;
  std::string session_;
  std::string words_;  ///< last status line
  uint64_t operator_ = 0;
  std::shared_ptr<const std::string> advertisement_;
  int64_t told_time_ = 0;  ///< [us] of a log, sent last
  Feed feed_;
  Sockets sockets_;
};

}  // namespace tread::view
