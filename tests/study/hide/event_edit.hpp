// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "common/log/event_log.hpp"

namespace tread::blind {

/// Applies a change to each message of a channel; events keep their order and time.
template <class Message, class Change>
void editEach(std::vector<LogEvent>& events, const Channel<Message>& channel, Change change) {
  for (LogEvent& event : events) {
    Message message;
    if (!decode(event, channel, message)) continue;
    change(message);
    event.bytes = encoded(message);
  }
}

/// All messages of a channel in the order of the log.
template <class Message>
std::vector<Message> messagesOf(const std::vector<LogEvent>& events,
                                const Channel<Message>& channel) {
  std::vector<Message> messages;
  Message message;
  for (const LogEvent& event : events)
    if (decode(event, channel, message)) messages.push_back(message);
  return messages;
}

}  // namespace tread::blind
