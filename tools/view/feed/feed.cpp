// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/view/feed/feed.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "common/bus/channels.hpp"
#include "common/types/message_json.hpp"

namespace tread::view {
namespace {

using Json = nlohmann::json;

constexpr double kNewsPeriod = 0.5;    // [s]
constexpr double kPlayerPeriod = 0.5;  // [s]

}  // namespace

Feed::Feed(std::function<bool(uint32_t)> wanted, Send send)
    : wanted_(std::move(wanted)), send_(std::move(send)) {}

void Feed::openLogs(const std::vector<std::string>& logs) {
  player_ = std::make_unique<LogPlayer>(logs);
  seek(player_->begin(), 0);
}

void Feed::take(const LogEvent& event) {
  history_.take(event);
  pass(event);
}

void Feed::pass(const LogEvent& event) {
  newest_ = std::max(newest_, event.utime);
  if (const auto message = messageOf(event)) send_(*message);
  newest_by_part_[{event.channel, partOf(event)}] = event;
  draw(event);
}

bool Feed::sceneWanted() const {
  const auto& topics = sceneTopics();
  return std::any_of(topics.begin(), topics.end(), [this](const auto& topic) {
    return wanted_(channels_.find(topic.first)->id);
  });
}

/// The scene costs more than a message: nobody looks, nothing is drawn.
void Feed::draw(const LogEvent& event) {
  if (!sceneWanted()) {
    scene_.reset();
    return;
  }
  if (!scene_) return redraw();
  for (SceneMessage& made : scene_->take(event)) show(std::move(made), event.utime);
}

void Feed::show(SceneMessage made, int64_t time) {
  const bool news = made.topic == "scene/events";
  const FeedMessage message{channels_.find(made.topic)->id, made.part, time,
                            std::make_shared<const std::string>(std::move(made.json)), news};
  if (!news) newest_scene_[{made.topic, made.part}] = message;
  send_(message);
}

void Feed::redraw() {
  scene_ = std::make_unique<SceneMaker>();
  newest_scene_.clear();
  std::vector<const LogEvent*> events;
  for (const auto& [part, event] : newest_by_part_)
    if (event.utime <= now()) events.push_back(&event);
  std::stable_sort(events.begin(), events.end(),
                   [](const LogEvent* a, const LogEvent* b) { return a->utime < b->utime; });
  for (const LogEvent* const event : events)
    for (SceneMessage& made : scene_->take(*event))
      // What had happened before is in the history.
      if (made.topic != "scene/events") show(std::move(made), event->utime);
}

std::optional<FeedMessage> Feed::messageOf(const LogEvent& event) const {
  const OfferedChannel* const channel = channels_.find(event.channel);
  const MessageType* const type = typeOfChannel(event.channel);
  if (channel == nullptr || type == nullptr || !wanted_(channel->id)) return std::nullopt;
  auto json = jsonOf(treadTypes(), *type, event.bytes);
  if (!json) return std::nullopt;
  return FeedMessage{channel->id, partOf(event), event.utime,
                     std::make_shared<const std::string>(std::move(*json)), false};
}

FeedMessage Feed::ownMessage(const char* topic, std::string json) const {
  return {channels_.find(topic)->id, 0, now(), std::make_shared<const std::string>(std::move(json)),
          std::string(topic) == kHistoryTopic};
}

std::string Feed::playerJson() const {
  Json json{{"live", !player_}, {"now", now()}, {"answered", answered_}};
  Json ages = Json::object();
  for (const ChannelSpec& spec : kChannels) ages[spec.name] = {spec.rate_hz, spec.max_age_ms};
  json["channels"] = ages;
  if (player_) {
    json["begin"] = player_->begin();
    json["end"] = player_->end();
    json["playing"] = playing_;
    json["speed"] = speed_;
    json["problem"] = player_->problem();
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void Feed::step(double elapsed) {
  if (player_ && playing_) {
    const int64_t to = player_->now() + static_cast<int64_t>(1e6 * elapsed * speed_);
    player_->advance(to, [this](const LogEvent& event) { pass(event); });
    if (to >= player_->end()) playing_ = false;
  }
  since_news_ += elapsed;
  since_player_ += elapsed;
  if (since_news_ >= kNewsPeriod && !player_) {
    since_news_ = 0.0;
    const std::string news = history_.news();
    if (!news.empty()) send_(ownMessage(kHistoryTopic, news));
  }
  if (since_player_ >= (playing_ ? kPlayerPeriod / 5.0 : kPlayerPeriod)) {
    since_player_ = 0.0;
    send_(ownMessage(kPlayerTopic, playerJson()));
  }
}

std::vector<FeedMessage> Feed::stateOf(uint32_t channel) {
  std::vector<FeedMessage> state;
  for (const auto& [part, event] : newest_by_part_)
    if (const OfferedChannel* const offered = channels_.find(part.first);
        offered != nullptr && offered->id == channel)
      if (auto message = messageOf(event)) state.push_back(std::move(*message));
  if (!scene_ && sceneWanted()) redraw();
  for (const auto& [part, message] : newest_scene_)
    if (message.channel == channel) state.push_back(message);

  if (channel == channels_.find(kHistoryTopic)->id)
    state.push_back(
        ownMessage(kHistoryTopic, player_ ? player_->history().whole() : history_.whole()));
  if (channel == channels_.find(kPlayerTopic)->id)
    state.push_back(ownMessage(kPlayerTopic, playerJson()));
  return state;
}

void Feed::seek(int64_t time, int64_t request) {
  if (!player_) return;
  const bool back = time < player_->now();
  player_->seek(std::clamp(time, player_->begin(), player_->end()),
                [this](const LogEvent& event) { pass(event); });
  // What is drawn now is not what was there before.
  if (back && scene_) redraw();
  answered_ = request;
  send_(ownMessage(kPlayerTopic, playerJson()));
}

void Feed::play(bool playing, double speed) {
  if (!player_) return;
  if (playing && player_->now() >= player_->end()) seek(player_->begin(), answered_);
  playing_ = playing;
  speed_ = std::clamp(speed, 0.1, 100.0);
  send_(ownMessage(kPlayerTopic, playerJson()));
}

}  // namespace tread::view
