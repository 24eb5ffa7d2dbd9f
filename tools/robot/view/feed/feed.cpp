// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/view/feed/feed.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "common/bus/channels.hpp"
#include "common/scene/scene_schemas.hpp"
#include "common/statistics/statistics.hpp"
#include "common/types/message_json.hpp"
#include "common/types/tread_types.hpp"

namespace tread::view {
namespace {

using Json = nlohmann::json;

constexpr double kNewsPeriod = 0.5;    // [s]
constexpr double kPlayerPeriod = 0.5;  // [s]
/// A drawn scene is reused for this time, so repeated subscriptions do not draw it each time.
constexpr double kSceneLife = 10.0;  // [s]

/// Memory for each channel [bytes]: enough for thousands of map tiles, and ample for the others.
constexpr size_t kMostOfMap = 24'000'000;
constexpr size_t kMostOfOthers = 4'000'000;

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
  const OfferedChannel* const channel = channels_.find(event.channel);
  if (channel == nullptr || typeOfChannel(event.channel) == nullptr) return;
  keep(event);
  if (wanted_(channel->id))
    if (const auto message = newest(channel->id, partOf(event))) send_(*message);
  draw(event);
}

void Feed::keep(const LogEvent& event) {
  KeptChannel& channel = kept_[channels_.find(event.channel)->id];
  Kept& kept = channel.parts[partOf(event)];
  channel.bytes += event.bytes.size() - kept.event.bytes.size();
  kept = {event, {}};
  const size_t most = event.channel == kMap.name ? kMostOfMap : kMostOfOthers;
  if (channel.bytes <= most) return;
  std::vector<int64_t> times;
  for (const auto& [part, other] : channel.parts) times.push_back(other.event.utime);
  const size_t quarter = times.size() / 4;
  const int64_t oldest_kept = valueAtRank(std::move(times), quarter);
  for (auto part = channel.parts.begin(); part != channel.parts.end();) {
    const bool old = part->second.event.utime <= oldest_kept;
    if (old) channel.bytes -= part->second.event.bytes.size();
    part = old ? channel.parts.erase(part) : std::next(part);
  }
}

bool Feed::sceneWanted() const {
  const auto& topics = sceneTopics();
  return std::any_of(topics.begin(), topics.end(), [this](const auto& topic) {
    return wanted_(channels_.find(topic.first)->id);
  });
}

/// The scene is expensive to draw, so it is drawn only for a viewer.
void Feed::draw(const LogEvent& event) {
  if (!scene_ && sceneWanted()) return redraw();
  if (!scene_) return;
  for (SceneMessage& made : scene_->take(event)) show(std::move(made), event.utime);
}

void Feed::show(SceneMessage made, int64_t time) {
  const bool news = made.topic == "scene/events";
  const FeedMessage message{channels_.find(made.topic)->id, made.part, time,
                            std::make_shared<const std::string>(std::move(made.json)), news};
  if (!news) newest_scene_[{message.channel, made.part}] = message;
  send_(message);
}

void Feed::redraw() {
  scene_ = std::make_unique<SceneMaker>();
  since_scene_ = 0.0;
  newest_scene_.clear();
  std::vector<const LogEvent*> events;
  for (const auto& [id, channel] : kept_)
    for (const auto& [part, kept] : channel.parts)
      if (kept.event.utime <= now()) events.push_back(&kept.event);
  std::stable_sort(events.begin(), events.end(),
                   [](const LogEvent* a, const LogEvent* b) { return a->utime < b->utime; });
  for (const LogEvent* const event : events)
    for (SceneMessage& made : scene_->take(*event))
      // Earlier events are in the history.
      if (made.topic != "scene/events") show(std::move(made), event->utime);
}

std::optional<FeedMessage> Feed::messageOf(uint32_t channel, uint64_t part, Kept& kept) const {
  std::shared_ptr<const std::string> json = kept.json.lock();
  if (!json) {
    auto made = jsonOf(treadTypes(), *typeOfChannel(kept.event.channel), kept.event.bytes);
    if (!made) return std::nullopt;
    json = std::make_shared<const std::string>(std::move(*made));
    kept.json = json;
  }
  return FeedMessage{channel, part, kept.event.utime, std::move(json), false};
}

FeedMessage Feed::ownMessage(const char* topic, std::string json) const {
  return {channels_.find(topic)->id, 0, now(), std::make_shared<const std::string>(std::move(json)),
          std::string(topic) == kHistoryTopic};
}

std::string Feed::playerJson() const {
  Json json{{"live", !player_}, {"now", now()}, {"answered", answered_}, {"doubt", doubt_}};
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
  since_scene_ = sceneWanted() ? 0.0 : since_scene_ + elapsed;
  if (since_scene_ > kSceneLife) scene_.reset();
  if (since_news_ >= kNewsPeriod) sendNews();
  if (since_player_ >= (playing_ ? kPlayerPeriod / 5.0 : kPlayerPeriod)) {
    since_player_ = 0.0;
    send_(ownMessage(kPlayerTopic, playerJson()));
  }
}

void Feed::sendNews() {
  since_news_ = 0.0;
  const std::string news = player_ ? "" : history_.news();
  if (!news.empty()) send_(ownMessage(kHistoryTopic, news));
}

std::vector<uint64_t> Feed::partsOf(uint32_t channel) {
  std::vector<uint64_t> parts;
  if (const auto found = kept_.find(channel); found != kept_.end())
    for (const auto& [part, kept] : found->second.parts) parts.push_back(part);
  if (!scene_ && sceneWanted()) redraw();
  for (const auto& [key, message] : newest_scene_)
    if (key.first == channel) parts.push_back(key.second);
  for (const char* own : {kHistoryTopic, kPlayerTopic})
    if (channel == channels_.find(own)->id) parts.push_back(0);
  return parts;
}

std::optional<FeedMessage> Feed::newest(uint32_t channel, uint64_t part) {
  if (channel == channels_.find(kPlayerTopic)->id) return ownMessage(kPlayerTopic, playerJson());
  if (channel == channels_.find(kHistoryTopic)->id) {
    // So that they are not sent again as news.
    sendNews();
    return ownMessage(kHistoryTopic, player_ ? player_->history().whole() : history_.whole());
  }
  if (const auto found = newest_scene_.find({channel, part}); found != newest_scene_.end())
    return found->second;
  const auto found = kept_.find(channel);
  if (found == kept_.end()) return std::nullopt;
  const auto kept = found->second.parts.find(part);
  if (kept == found->second.parts.end()) return std::nullopt;
  return messageOf(channel, part, kept->second);
}

void Feed::seek(int64_t time, int64_t request) {
  if (!player_) return;
  const bool back = time < player_->now();
  player_->seek(std::clamp(time, player_->begin(), player_->end()),
                [this](const LogEvent& event) { pass(event); });
  // The drawn scene belongs to a later time.
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
