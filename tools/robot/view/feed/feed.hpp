// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/scene/scene.hpp"
#include "tools/robot/view/feed/channels.hpp"
#include "tools/robot/view/feed/history.hpp"
#include "tools/robot/view/feed/log_player.hpp"

namespace tread::view {

/// A message for viewers.
struct FeedMessage {
  uint32_t channel = 0;
  uint64_t part = 0;                           ///< part of its channel that it replaces
  int64_t time = 0;                            ///< [us] of recording
  std::shared_ptr<const std::string> payload;  ///< JSON
  bool is_news = false;  ///< replaces nothing: the earlier ones must be delivered, too
};

/// Converts messages of the bus or of a log for viewers, and keeps the newest for later viewers.
/** Converts to JSON only what is subscribed to. */
class Feed {
 public:
  using Send = std::function<void(const FeedMessage&)>;
  /// `wanted`: whether a channel has subscribers; `send`: sends to all of them.
  Feed(std::function<bool(uint32_t)> wanted, Send send);

  const OfferedChannels& channels() const { return channels_; }

  /// Opens logs, which are played instead of a bus.
  void openLogs(const std::vector<std::string>& logs);
  /// Processes a message of the bus.
  void take(const LogEvent& event);
  /// A caveat about the displayed data; empty = none.
  void setDoubt(const std::string& words) { doubt_ = words; }
  /// Call often. `elapsed` [s] of real time since the last call.
  void step(double elapsed);

  /// Parts of a channel that a new viewer needs at once.
  std::vector<uint64_t> partsOf(uint32_t channel);
  /// The newest message of such a part; nullopt if there is none.
  std::optional<FeedMessage> newest(uint32_t channel, uint64_t part);

  /// Controls a log's playback; no effect without a log.
  void seek(int64_t time, int64_t request);
  void play(bool playing, double speed);
  bool hasLog() const { return player_ != nullptr; }
  /// Damage of the log in one line; empty if none.
  std::string problem() const { return player_ ? player_->problem() : ""; }
  /// [us] time of the displayed data.
  int64_t now() const { return player_ ? player_->now() : newest_; }

 private:
  void pass(const LogEvent& event);
  void draw(const LogEvent& event);
  void show(SceneMessage made, int64_t time);
  bool sceneWanted() const;
  /// Redraws the scene from the newest parts: it was not drawn before, or time went back.
  void redraw();

  /// The newest message of each part. Its JSON is shared with the queues.
  struct Kept {
    LogEvent event;
    std::weak_ptr<const std::string> json;
  };
  struct KeptChannel {
    std::map<uint64_t, Kept> parts;
    size_t bytes = 0;
  };
  void keep(const LogEvent& event);
  std::optional<FeedMessage> messageOf(uint32_t channel, uint64_t part, Kept& kept) const;
  void sendNews();
  FeedMessage ownMessage(const char* topic, std::string json) const;
  std::string playerJson() const;

  OfferedChannels channels_;
  std::function<bool(uint32_t)> wanted_;
  Send send_;
  std::map<uint32_t, KeptChannel> kept_;
  std::map<std::pair<uint32_t, uint64_t>, FeedMessage> newest_scene_;  ///< by channel and part

  std::unique_ptr<SceneMaker> scene_;  ///< null: no viewer
  double since_scene_ = 0.0;           ///< [s] since the last viewer

  static constexpr size_t kMostHistory = 2000;
  History history_{kMostHistory};  ///< of a bus
  std::unique_ptr<LogPlayer> player_;
  std::string doubt_;
  int64_t newest_ = 0;
  bool playing_ = false;
  double speed_ = 1.0;
  double since_news_ = 0.0;    ///< [s]
  double since_player_ = 0.0;  ///< [s]
  int64_t answered_ = 0;       ///< the seek that was answered last
};

}  // namespace tread::view
