// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tools/robot/view/admission.hpp"
#include "tools/robot/view/feed/frame_queue.hpp"
#include "tools/robot/view/limits.hpp"

struct lws;

namespace tread::view {

/// Channel number of a text frame for one client; no channel has it.
constexpr uint32_t kText = UINT32_MAX;

/// One WebSocket of a viewer.
struct Client {
  lws* socket = nullptr;
  uint64_t number = 0;
  bool may_command = false;
  bool asked = false;  ///< waiting for libwebsockets to report a writable line
  bool held = false;   ///< its requests are not read
  std::map<uint32_t, uint32_t> subscriptions;  ///< by channel
  std::map<uint32_t, std::string> topics;      ///< its own channels
  FrameQueue frames;
  std::string received;
  Allowance requests{kRequestRate, kRequestBurst};

  /// A client that is behind gets no texts.
  void pushText(std::string text) {
    if (!frames.isCrowded())
      frames.push({{kText, 0}, 0, std::make_shared<const std::string>(std::move(text)), false});
  }
};

/// Callbacks of the sockets into the server.
struct SocketEvents {
  std::function<void(Client&)> opened, closed;
  std::function<void(Client&, const std::string& message, bool binary)> received;
  /// The payload for a queued frame; empty = obsolete.
  std::function<std::pair<std::string, bool>(const Client&, const Frame&)> bytesOf;
};

/// The viewers' sockets, with libwebsockets: admission, scheduling, limits.
class Sockets {
 public:
  /// Throws std::runtime_error with one clear line if the address cannot be used.
  Sockets(const ServerSettings& settings, SocketEvents events);
  ~Sockets();
  Sockets(const Sockets&) = delete;
  Sockets& operator=(const Sockets&) = delete;

  std::list<Client>& clients() { return clients_; }
  const std::list<Client>& clients() const { return clients_; }
  int port() const;
  /// Serves what is due without waiting. `elapsed` [s] since the last call; `operates`: number of
  /// the client that holds the robot, 0 = none; `limited`: a robot on this host needs the
  /// processor.
  void step(double elapsed, uint64_t operates, bool limited);

 private:
  struct Library;

  bool hasRoom(lws* socket) const;
  void accept(lws* listener);
  void listenAgain();
  void open(lws* socket);
  void close(lws* socket);
  int receive(lws* socket, const char* bytes, size_t size);
  int write(lws* socket);
  void holdOthers();
  void giveTurns();
  Client* find(lws* socket);
  bool operates(const Client& client) const { return client.number == operator_; }

  ServerSettings settings_;
  SocketEvents events_;
  std::list<Client> clients_;
  Limits limits_;
  uint64_t numbers_ = 0;
  uint64_t operator_ = 0;
  lws* listener_ = nullptr;  ///< its connections wait
  std::vector<unsigned char> buffer_;
  std::unique_ptr<Library> library_;
};

}  // namespace tread::view
