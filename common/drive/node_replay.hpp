// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "common/drive/log_bus.hpp"
#include "common/store/store.hpp"

namespace tread {

/// Plays a log to a node of its own, which begins with an empty store and steps at its period.
template <class NodeType>
class NodeReplay {
 public:
  /// Receives the node's messages after each step.
  using Take = std::function<void(const LogEvent&)>;
  /// The time of a step, from the time that its period gives [us].
  using Schedule = std::function<int64_t(int64_t)>;

  /// The first step is at `first_step` [us]; -1 = at the first event.
  template <class Config>
  NodeReplay(const Config& config, int64_t boot_id, Take take, int64_t first_step = -1)
      : bus_(boot_id),
        node_(config, bus_, store_),
        next_step_(first_step),
        take_(std::move(take)) {}

  void setSchedule(Schedule schedule) { schedule_ = std::move(schedule); }

  bool hears(const std::string& channel) const { return bus_.hears(channel); }
  NodeType& node() { return node_; }
  const NodeType& node() const { return node_; }

  /// Passes an event on at its time, after the steps until then. Times must not decrease.
  void play(const LogEvent& event) {
    stepUntil(event.utime);
    bus_.setNow(event.utime);
    bus_.hear(event);
  }

  void stepUntil(int64_t utime) {
    if (next_step_ < 0) next_step_ = utime;
    for (; next_step_ <= utime; next_step_ += node_.period()) {
      if (schedule_) next_step_ = schedule_(next_step_);
      bus_.setNow(next_step_);
      node_.step(next_step_);
      for (const LogEvent& event : bus_.takePublished()) take_(event);
    }
  }

 private:
  MemoryStore store_;
  LogBus bus_;
  NodeType node_;
  int64_t next_step_;
  Take take_;
  Schedule schedule_;
};

}  // namespace tread
