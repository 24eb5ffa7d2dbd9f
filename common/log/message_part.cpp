// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/log/message_part.hpp"

#include <functional>

namespace tread {
namespace {

/// Whether the event is on the channel; sets the part from its message.
template <class Message, class Part>
bool isOn(const LogEvent& event, const Channel<Message>& channel, const Part& part,
          uint64_t& result) {
  if (event.channel != channel.name) return false;
  Message message;
  if (decode(event, channel, message)) result = part(message);
  return true;
}

}  // namespace

uint64_t partOf(const LogEvent& event) {
  const auto hash = [](const std::string& name) { return std::hash<std::string>()(name); };
  const auto ofTile = [](const map_tile_t& tile) {
    return static_cast<uint64_t>(static_cast<uint32_t>(tile.tile_x)) << 32 |
           static_cast<uint32_t>(tile.tile_y);
  };
  const auto ofSet = [](const pattern_set_part_t& part) {
    return static_cast<uint64_t>(part.part);
  };
  const auto ofFence = [&](const fence_t& fence) { return hash(fence.fence_name); };
  const auto ofKeeper = [&](const fences_t& fences) { return hash(fences.keeper); };
  const auto ofHealth = [&](const health_t& health) { return hash(health.process); };
  const auto ofConfig = [&](const config_t& config) { return hash(config.config_process); };
  uint64_t part = 0;
  const bool has_parts =
      isOn(event, kMap, ofTile, part) || isOn(event, kPatternSet, ofSet, part) ||
      isOn(event, kFence, ofFence, part) || isOn(event, kFences, ofKeeper, part) ||
      isOn(event, kHealth, ofHealth, part) || isOn(event, kConfig, ofConfig, part);
  return has_parts ? part : 0;
}

}  // namespace tread
