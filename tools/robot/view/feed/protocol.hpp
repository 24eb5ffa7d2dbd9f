// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tools/robot/view/feed/channels.hpp"

namespace tread::view {

// The Foxglove WebSocket protocol (foxglove/ws-protocol, docs/spec.md), as far as it is used here.

/// Names of the protocol; newer clients use the second one for the same messages.
inline constexpr const char* kSubprotocols[] = {"foxglove.websocket.v1", "foxglove.sdk.v1"};

/// `may_publish`: this client may send commands; `has_time`: the server sends the time of a log.
/// `session`: unique per server.
std::string serverInfo(const std::string& name, bool may_publish, bool has_time,
                       const std::string& session);
std::string advertisement(const OfferedChannels& channels);
/// `level`: 0 info, 1 warning, 2 error.
std::string statusMessage(int level, const std::string& words);
/// A frame of a channel's message; `time` [us] of its recording.
std::string messageFrame(uint32_t subscription, int64_t time, const std::string& payload);
/// Time [us] of the log being played.
std::string timeFrame(int64_t time);

/// A client's request.
struct ClientRequest {
  std::vector<std::pair<uint32_t, uint32_t>> subscribe;     ///< subscription and channel
  std::vector<uint32_t> unsubscribe;                        ///< subscriptions
  std::vector<std::pair<uint32_t, std::string>> advertise;  ///< its own channels and their topics
  std::vector<uint32_t> unadvertise;
  std::string problem;  ///< error in the request; empty = none
};
/// Parses a client's text message.
ClientRequest readRequest(const std::string& text);

/// Parses a client's message on its own channel; false if the bytes are invalid.
bool readClientFrame(const std::string& bytes, uint32_t& channel, std::string& payload);

}  // namespace tread::view
