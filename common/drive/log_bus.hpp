// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "common/bus/lcm_bus.hpp"
#include "common/log/event_log.hpp"

namespace tread {

/// The bus of one node that receives a log: the replay sets the time, and no message is lost.
/** The node's own messages are collected and not delivered, so that it never receives its own past.
 */
class LogBus : public Bus {
 public:
  explicit LogBus(int64_t boot_id) : now_(boot_id), boot_id_(boot_id) {}

  int64_t now() const override { return knowsTime() ? now_ : start_->now(now_); }
  int64_t bootId() const override { return boot_id_; }
  void setNow(int64_t utime) { now_ = utime; }
  /// Behaves like a process that has just started on a real host: the time is unknown until enough
  /// messages agree on it.
  void forgetTime() { start_.emplace(now_, LcmBus::kMaxJump); }
  bool knowsTime() const { return !start_ || start_->started(); }

  /// Hands an event to the node's handlers.
  void hear(const LogEvent& event) {
    receive(event.channel, event.bytes.data(), event.bytes.size());
  }
  /// The same for a message that the node overhears and that is not its input.
  void overhear(const LogEvent& event) {
    overhearing_ = true;
    hear(event);
    overhearing_ = false;
  }

  /// Messages published since the last call, at the time of publishing.
  std::vector<LogEvent> takePublished() { return std::move(published_); }

 protected:
  bool send(const char* channel, const uint8_t* bytes, size_t size) override {
    published_.push_back({now_, channel, {bytes, bytes + size}});
    return true;
  }
  void listen(const char* /*channel*/) override {}
  bool hasCompany() const override { return overhearing_; }
  bool onReceipt(int64_t utime) override { return knowsTime() || start_->observe(utime, now_); }

 private:
  int64_t now_;
  int64_t boot_id_;
  std::optional<FollowedTime> start_;
  bool overhearing_ = false;
  std::vector<LogEvent> published_;
};

}  // namespace tread
