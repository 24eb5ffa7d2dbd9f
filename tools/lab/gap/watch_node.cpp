// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/gap/watch_node.hpp"

#include <iostream>
#include <stdexcept>

#include "common/messages/blank.hpp"

namespace tread::gap {

WatchNode::WatchNode(Bus& bus, const ModelDocument& model, const WatchLimits& limits)
    : bus_(bus),
      health_(bus, "gap_watch", "model: " + model.vehicle.name + "\n"),
      drive_(model, limits) {
  listen(kIns);
  listen(kMotor);
  listen(kHealth);
}

template <class Message>
void WatchNode::listen(const tread::Channel<Message>& channel) {
  bus_.subscribe<Message>(
      channel, [this, &channel](const Message& message) { hear(eventOf(channel, message)); });
}

void WatchNode::step(int64_t utime) {
  now_ = utime;
  health_.setCounter("seconds of driving compared", static_cast<int64_t>(drive_.compared()));
  health_.step(utime);
}

void WatchNode::hear(const LogEvent& event) {
  if (failed_) return;
  try {
    if (const auto line = drive_.take(event)) say(*line);
  } catch (const std::runtime_error& error) {
    failed_ = true;
    std::cerr << "tread-gap watch: " << error.what() << std::endl;
    health_.fail(error.what());
  }
}

void WatchNode::say(const WatchLine& line) {
  anything_ = true;
  std::cout << line.text << std::endl;
  health_.setState(line.as_model ? health_t::HEALTH_OK : health_t::HEALTH_DEGRADED,
                   line.as_model ? "" : line.text);
  auto mark = blank<mark_t>();
  mark.utime = now_;
  mark.seq = seq_++;
  mark.mark_kind = line.as_model ? "no gap" : "gap";
  mark.mark_value = line.text;
  bus_.publish(kMark, mark);
}

}  // namespace tread::gap
