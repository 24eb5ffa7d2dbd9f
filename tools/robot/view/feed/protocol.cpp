// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/view/feed/protocol.hpp"

#include <nlohmann/json.hpp>

namespace tread::view {
namespace {

using Json = nlohmann::json;

constexpr char kMessageData = 0x01;  // the same in both directions
constexpr char kTime = 0x02;

void appendLittleEndian(std::string& bytes, uint64_t value, int size) {
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> (8 * i));
}

uint64_t nanoseconds(int64_t time) {
  return time > 0 ? static_cast<uint64_t>(time) * 1000 : 0;
}

/// The numbers in an array; throws Json::exception for other entries.
std::vector<uint32_t> numbersIn(const Json& message, const char* key) {
  return message.at(key).get<std::vector<uint32_t>>();
}

void read(const Json& message, ClientRequest& request) {
  const auto op = message.at("op").get<std::string>();
  if (op == "subscribe") {
    for (const Json& entry : message.at("subscriptions"))
      request.subscribe.emplace_back(entry.at("id").get<uint32_t>(),
                                     entry.at("channelId").get<uint32_t>());
  } else if (op == "unsubscribe") {
    request.unsubscribe = numbersIn(message, "subscriptionIds");
  } else if (op == "advertise") {
    for (const Json& entry : message.at("channels")) {
      request.advertise.emplace_back(entry.at("id").get<uint32_t>(),
                                     entry.at("topic").get<std::string>());
      if (entry.value("encoding", "json") != "json")
        request.problem = "only JSON can be published here";
    }
  } else if (op == "unadvertise") {
    request.unadvertise = numbersIn(message, "channelIds");
  } else {
    request.problem = "this server does not know the operation '" + op + "'";
  }
}

}  // namespace

std::string serverInfo(const std::string& name, bool may_publish, bool has_time,
                       const std::string& session) {
  Json capabilities = Json::array();
  if (has_time) capabilities.push_back("time");
  if (may_publish) capabilities.push_back("clientPublish");
  return Json{{"op", "serverInfo"},           {"name", name},
              {"capabilities", capabilities}, {"supportedEncodings", {"json"}},
              {"metadata", Json::object()},   {"sessionId", session}}
      .dump();
}

std::string advertisement(const OfferedChannels& channels) {
  Json offered = Json::array();
  for (const OfferedChannel& channel : channels.all())
    offered.push_back({{"id", channel.id},
                       {"topic", channel.topic},
                       {"encoding", "json"},
                       {"schemaName", channel.schema_name},
                       {"schema", channel.schema},
                       {"schemaEncoding", "jsonschema"}});
  return Json{{"op", "advertise"}, {"channels", offered}}.dump();
}

std::string statusMessage(int level, const std::string& words) {
  return Json{{"op", "status"}, {"level", level}, {"message", words}}.dump(
      -1, ' ', false, Json::error_handler_t::replace);
}

std::string messageFrame(uint32_t subscription, int64_t time, const std::string& payload) {
  std::string frame(1, kMessageData);
  frame.reserve(13 + payload.size());
  appendLittleEndian(frame, subscription, 4);
  appendLittleEndian(frame, nanoseconds(time), 8);
  return frame += payload;
}

std::string timeFrame(int64_t time) {
  std::string frame(1, kTime);
  appendLittleEndian(frame, nanoseconds(time), 8);
  return frame;
}

ClientRequest readRequest(const std::string& text) {
  ClientRequest request;
  try {
    read(Json::parse(text), request);
  } catch (const Json::exception&) {
    request.problem = "ignored a message that is not a request of the protocol";
  }
  return request;
}

bool readClientFrame(const std::string& bytes, uint32_t& channel, std::string& payload) {
  if (bytes.size() < 5 || bytes[0] != kMessageData) return false;
  channel = 0;
  for (int i = 0; i < 4; ++i)
    channel |= static_cast<uint32_t>(static_cast<uint8_t>(bytes[static_cast<size_t>(1 + i)]))
               << (8 * i);
  payload = bytes.substr(5);
  return true;
}

}  // namespace tread::view
