// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/view/view_server.hpp"

#include <algorithm>
#include <chrono>

#include <nlohmann/json.hpp>

namespace tread::view {
namespace {

using Json = nlohmann::json;

// Numbers that no channel has: frames for all clients, of which the newest counts.
constexpr uint32_t kTime = UINT32_MAX - 1;
constexpr uint32_t kWords = UINT32_MAX - 2;

constexpr const char* kCommandTopic = "view/command";
constexpr const char* kControlTopic = "view/control";

}  // namespace

ViewServer::ViewServer(const ServerSettings& settings, Command command, Leave leave)
    : command_(std::move(command)),
      leave_(std::move(leave)),
      session_(std::to_string(std::chrono::system_clock::now().time_since_epoch().count())),
      advertisement_(std::make_shared<const std::string>(advertisement(OfferedChannels()))),
      feed_([this](uint32_t channel) { return wanted(channel); },
            [this](const FeedMessage& message) { send(message); }),
      sockets_(settings, {[this](Client& client) { greet(client); },
                          [this](Client& client) { leave_(client.number); },
                          [this](Client& client, const std::string& text, bool binary) {
                            receive(client, text, binary);
                          },
                          [this](const Client& client, const Frame& frame) {
                            return bytesOf(client, frame);
                          }}) {}

void ViewServer::greet(Client& client) {
  client.pushText(
      serverInfo("tread-view", client.may_command || feed_.hasLog(), feed_.hasLog(), session_));
  client.frames.push({{kText, 0}, 0, advertisement_, false});
  if (!words_.empty()) client.frames.pushNewest({kWords, 0});
}

std::pair<std::string, bool> ViewServer::bytesOf(const Client& client, const Frame& frame) {
  const auto& [channel, part] = frame.part;
  if (channel == kText) return {*frame.payload, true};
  if (channel == kWords) return {statusMessage(0, words_), true};
  if (channel == kTime) return {timeFrame(feed_.now()), false};
  const auto subscription = client.subscriptions.find(channel);
  if (subscription == client.subscriptions.end()) return {};
  if (frame.payload) return {messageFrame(subscription->second, frame.time, *frame.payload), false};
  const std::optional<FeedMessage> newest = feed_.newest(channel, part);
  if (!newest) return {};
  return {messageFrame(subscription->second, newest->time, *newest->payload), false};
}

void ViewServer::step(double elapsed) {
  feed_.step(elapsed);
  if (feed_.hasLog() && feed_.now() != told_time_) {
    told_time_ = feed_.now();
    for (Client& client : sockets_.clients()) client.frames.pushNewest({kTime, 0});
  }
  sockets_.step(elapsed, operator_, !feed_.hasLog());
}

void ViewServer::tell(const std::string& words) {
  words_ = words;
  for (Client& client : sockets_.clients()) client.frames.pushNewest({kWords, 0});
}

bool ViewServer::wanted(uint32_t channel) const {
  return std::any_of(sockets_.clients().begin(), sockets_.clients().end(),
                     [&](const Client& client) { return client.subscriptions.count(channel) > 0; });
}

void ViewServer::send(const FeedMessage& message) {
  for (Client& client : sockets_.clients())
    if (client.subscriptions.count(message.channel) > 0)
      client.frames.push(
          {{message.channel, message.part}, message.time, message.payload, message.is_news});
}

void ViewServer::receive(Client& client, const std::string& text, bool binary) {
  if (!binary) return serve(client, readRequest(text));
  uint32_t channel = 0;
  std::string payload;
  if (!readClientFrame(text, channel, payload)) return;
  const auto topic = client.topics.find(channel);
  if (topic != client.topics.end()) control(client, topic->second, payload);
}

void ViewServer::serve(Client& client, const ClientRequest& request) {
  if (!request.problem.empty()) client.pushText(statusMessage(1, request.problem));
  for (const auto& [subscription, channel] : request.subscribe) {
    if (channel == 0 || channel > feed_.channels().all().size()) {
      client.pushText(statusMessage(1, "there is no channel " + std::to_string(channel)));
      continue;
    }
    // A repeated subscription only changes the name.
    const bool first = client.subscriptions.count(channel) == 0;
    client.subscriptions[channel] = subscription;
    if (!first) continue;
    for (const uint64_t part : feed_.partsOf(channel)) client.frames.pushNewest({channel, part});
  }
  for (const uint32_t subscription : request.unsubscribe)
    for (auto entry = client.subscriptions.begin(); entry != client.subscriptions.end();)
      entry = entry->second == subscription ? client.subscriptions.erase(entry) : std::next(entry);
  for (const auto& [id, topic] : request.advertise)
    if (client.topics.size() < kMostTopics || client.topics.count(id) > 0)
      client.topics[id] = topic.substr(0, kLongestTopic);
  for (const uint32_t id : request.unadvertise) client.topics.erase(id);
}

void ViewServer::control(Client& client, const std::string& topic, const std::string& payload) {
  std::string problem;
  if (topic == kCommandTopic) {
    problem = client.may_command ? command_(payload, client.number)
                                 : "this page may look, but not operate the robot";
  } else if (topic == kControlTopic) {
    try {
      const Json json = Json::parse(payload);
      const auto op = json.at("op").get<std::string>();
      if (op == "seek")
        feed_.seek(json.at("time").get<int64_t>(), json.value("request", int64_t{0}));
      if (op == "play") feed_.play(true, json.value("speed", 1.0));
      if (op == "pause") feed_.play(false, json.value("speed", 1.0));
    } catch (const Json::exception&) {
      problem = "ignored an unreadable control message";
    }
  } else {
    problem = "nobody listens to " + topic + " here";
  }
  if (!problem.empty()) client.pushText(statusMessage(1, problem));
}

}  // namespace tread::view
