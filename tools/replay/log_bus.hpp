// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/bus/lcm_bus.hpp"
#include "common/log/event_log.hpp"

namespace tread::replay {

/// The bus of one node that hears a log: time is what the replay says, and nothing is lost.
/** What the node publishes is kept and reaches nobody, so it never hears its own past. */
class LogBus : public Bus {
 public:
  explicit LogBus(int64_t boot_id) : now_(boot_id), boot_id_(boot_id) {}

  int64_t now() const override { return knowsTime() ? now_ : start_->now(now_); }
  int64_t bootId() const override { return boot_id_; }
  void setNow(int64_t utime) { now_ = utime; }
  /// From here as a process on a real host that has just started: it does not know the time before
  /// it has heard enough to believe it.
  void forgetTime() { start_.emplace(now_, LcmBus::kMaxJump); }
  bool knowsTime() const { return !start_ || start_->started(); }

  /// Hands an event to the node's handlers.
  void hear(const LogEvent& event) {
    const auto found = handlers_.find(event.channel);
    if (found == handlers_.end()) return;
    for (const RawHandler& handler : found->second)
      deliver(handler, event.channel.c_str(), event.bytes.data(), event.bytes.size());
  }
  bool hears(const std::string& channel) const { return handlers_.count(channel) > 0; }
  /// The channels that the node has subscribed to, sorted.
  std::vector<std::string> heard() const {
    std::vector<std::string> channels;
    for (const auto& [channel, handlers] : handlers_) channels.push_back(channel);
    return channels;
  }

  /// What the node has published since the last call; the time is that of publishing.
  std::vector<LogEvent> takePublished() { return std::move(published_); }

 protected:
  bool send(const char* channel, const uint8_t* bytes, size_t size) override {
    published_.push_back({now_, channel, {bytes, bytes + size}});
    return true;
  }
  void listen(const char* channel, RawHandler handler) override {
    handlers_[channel].push_back(std::move(handler));
  }
  bool onReceipt(int64_t utime) override { return knowsTime() || start_->observe(utime, now_); }

 private:
  int64_t now_;
  int64_t boot_id_;
  std::optional<FollowedTime> start_;
  std::map<std::string, std::vector<RawHandler>> handlers_;
  std::vector<LogEvent> published_;
};

}  // namespace tread::replay
