// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/replay/log_bus.hpp"

namespace tread::replay {

void LogBus::hear(const LogEvent& event) {
  const auto found = handlers_.find(event.channel);
  if (found == handlers_.end()) return;
  for (const RawHandler& handler : found->second)
    deliver(handler, event.channel.c_str(), event.bytes.data(), event.bytes.size());
}

std::vector<std::string> LogBus::heard() const {
  std::vector<std::string> channels;
  for (const auto& [channel, handlers] : handlers_) channels.push_back(channel);
  return channels;
}

bool LogBus::send(const char* channel, const uint8_t* bytes, size_t size) {
  published_.push_back({now_, channel, {bytes, bytes + size}});
  return true;
}

void LogBus::listen(const char* channel, RawHandler handler) {
  handlers_[channel].push_back(std::move(handler));
}

}  // namespace tread::replay
