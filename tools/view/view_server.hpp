// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "tools/view/admission.hpp"
#include "tools/view/feed/feed.hpp"
#include "tools/view/feed/protocol.hpp"

namespace tread::view {

/// The page as one HTML file; made by the build.
std::string_view pageText();

/// Serves the page by HTTP and the feed by WebSocket (the Foxglove protocol), with libwebsockets.
/** One thread: step() does all. A slow viewer gets the newest of each channel's parts, and never
 * holds up the others. What viewers may cost together is limited: places, requests, bytes. */
class ViewServer {
 public:
  /// `command`: of a page, with the page's number; returns what is wrong with it, empty = taken.
  using Command = std::function<std::string(const std::string& json, uint64_t page)>;
  using Leave = std::function<void(uint64_t page)>;

  /// Throws std::runtime_error with one clear line if the address cannot be used.
  ViewServer(const ServerSettings& settings, Command command, Leave leave);
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  Feed& feed() { return feed_; }
  /// Serves what is due without waiting. `elapsed` [s] since the last call.
  void step(double elapsed);
  /// Tells all pages in a line how things are; the newest counts.
  void tell(const std::string& words);
  /// The page that holds the robot; 0 = none. It does not wait for others.
  void setOperator(uint64_t page) { operator_ = page; }
  int port() const { return port_; }

 private:
  struct Client;
  struct Sockets;

  bool wanted(uint32_t channel) const;
  void send(const FeedMessage& message);
  void receive(Client& client, const std::string& text, bool binary);
  void serve(Client& client, const ClientRequest& request);
  void control(Client& client, const std::string& topic, const std::string& payload);

  ServerSettings settings_;
  Command command_;
  Leave leave_;
  std::string session_;
  int port_ = 0;
  std::string words_;  ///< told last
  uint64_t operator_ = 0;
  std::shared_ptr<const std::string> advertisement_;
  int64_t told_time_ = 0;  ///< [us] of a log, told to viewers last
  Feed feed_;
  std::unique_ptr<Sockets> sockets_;
};

}  // namespace tread::view
