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
  /// A line about how far to trust what is shown; empty = none.
  void setDoubt(const std::string& words) { doubt_ = words; }
  /// Call it often. `elapsed` [s] of real time since the last call.
  void step(double elapsed);

  /// The parts of which a viewer of a channel must know the newest at once.
  std::vector<uint64_t> partsOf(uint32_t channel);
  /// The newest of such a part; nothing if there is none any more.
  std::optional<FeedMessage> newest(uint32_t channel, uint64_t part);

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

  /// The newest of a channel by part. Its JSON is shared while anybody still has it.
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

  std::unique_ptr<SceneMaker> scene_;  ///< null: nobody looks
  double since_scene_ = 0.0;           ///< [s] since somebody looked

  static constexpr size_t kMostHistory = 2000;
  History history_{kMostHistory};  ///< of a bus
  std::unique_ptr<LogPlayer> player_;
  std::string doubt_;
  int64_t newest_ = 0;
  bool playing_ = false;
  double speed_ = 1.0;
  double since_news_ = 0.0;    ///< [s]
  double since_player_ = 0.0;  ///< [s]
  int64_t answered_ = 0;       ///< the seek that was served last
};

}  // namespace tread::view
