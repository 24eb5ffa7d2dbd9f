// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tools/robot/view/feed/channels.hpp"

namespace tread::view {

// The Foxglove WebSocket protocol (foxglove/ws-protocol, docs/spec.md), as far as we speak it.

/// Names under which viewers ask for it; the second is what newer ones say to the same words.
inline constexpr const char* kSubprotocols[] = {"foxglove.websocket.v1", "foxglove.sdk.v1"};

/// `may_publish`: whether this client may send commands; `has_time`: the server tells the time,
/// that of a log. `session`: differs for each server.
std::string serverInfo(const std::string& name, bool may_publish, bool has_time,
                       const std::string& session);
std::string advertisement(const OfferedChannels& channels);
/// `level`: 0 info, 1 warning, 2 error.
std::string statusMessage(int level, const std::string& words);
/// A frame of a channel's message; `time` [us] of its recording.
std::string messageFrame(uint32_t subscription, int64_t time, const std::string& payload);
/// The time [us] of a log that is played.
std::string timeFrame(int64_t time);

/// What a client asks for.
struct ClientRequest {
  std::vector<std::pair<uint32_t, uint32_t>> subscribe;     ///< subscription and channel
  std::vector<uint32_t> unsubscribe;                        ///< subscriptions
  std::vector<std::pair<uint32_t, std::string>> advertise;  ///< its own channels and their topics
  std::vector<uint32_t> unadvertise;
  std::string problem;  ///< what is wrong with the request; empty = nothing
};
/// Reads a client's text message.
ClientRequest readRequest(const std::string& text);

/// A client's message on a channel of its own; false if the bytes are none.
bool readClientFrame(const std::string& bytes, uint32_t& channel, std::string& payload);

}  // namespace tread::view
