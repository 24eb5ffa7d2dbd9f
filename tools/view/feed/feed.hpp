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
#include "tools/view/feed/channels.hpp"
#include "tools/view/feed/history.hpp"
#include "tools/view/feed/log_player.hpp"

namespace tread::view {

/// A message for viewers.
struct FeedMessage {
  uint32_t channel = 0;
  uint64_t part = 0;                           ///< what of its channel it replaces
  int64_t time = 0;                            ///< [us] of recording
  std::shared_ptr<const std::string> payload;  ///< JSON
  bool is_news = false;  ///< it replaces nothing: what came before must be heard, too
};

/// Turns messages of the bus or of a log into what viewers subscribe to, and remembers the newest
/// for those who come later.
/** Only what somebody wants is turned into JSON. */
class Feed {
 public:
  using Send = std::function<void(const FeedMessage&)>;
  /// `wanted`: whether anybody subscribes to a channel; `send`: to all who do.
  Feed(std::function<bool(uint32_t)> wanted, Send send);

  const OfferedChannels& channels() const { return channels_; }

  /// Opens logs; from then on they are played instead of a bus.
  void openLogs(const std::vector<std::string>& logs);
  /// A message of the bus.
  void take(const LogEvent& event);
  /// Call it often. `elapsed` [s] of real time since the last call.
  void step(double elapsed);

  /// What a viewer of a channel must know at once.
  std::vector<FeedMessage> stateOf(uint32_t channel);

  /// Control of a log's playback; without a log nothing.
  void seek(int64_t time, int64_t request);
  void play(bool playing, double speed);
  bool hasLog() const { return player_ != nullptr; }
  /// One clear line of what is wrong with the log; empty if nothing is.
  std::string problem() const { return player_ ? player_->problem() : ""; }
  /// [us] the time of what is shown.
  int64_t now() const { return player_ ? player_->now() : newest_; }

 private:
  void pass(const LogEvent& event);
  void draw(const LogEvent& event);
  void show(SceneMessage made, int64_t time);
  bool sceneWanted() const;
  /// The scene anew, from the newest of all parts up to now: it was not drawn, or time went back.
  void redraw();

  std::optional<FeedMessage> messageOf(const LogEvent& event) const;
  FeedMessage ownMessage(const char* topic, std::string json) const;
  std::string playerJson() const;

  OfferedChannels channels_;
  std::function<bool(uint32_t)> wanted_;
  Send send_;
  std::map<std::pair<std::string, uint64_t>, LogEvent> newest_by_part_;
  std::map<std::pair<std::string, uint64_t>, FeedMessage> newest_scene_;  ///< by topic and part

  std::unique_ptr<SceneMaker> scene_;  ///< null: nobody looks

  History history_;  ///< of a bus
  std::unique_ptr<LogPlayer> player_;
  int64_t newest_ = 0;
  bool playing_ = false;
  double speed_ = 1.0;
  double since_news_ = 0.0;    ///< [s]
  double since_player_ = 0.0;  ///< [s]
  int64_t answered_ = 0;       ///< the seek that was served last
};

}  // namespace tread::view
