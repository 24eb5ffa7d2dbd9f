// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/log/message_part.hpp"

#include <functional>

namespace tread {

uint64_t partOf(const LogEvent& event) {
  map_tile_t tile;
  health_t health;
  config_t config;
  pattern_set_part_t part;
  if (event.channel == kMap.name && decode(event, kMap, tile))
    return static_cast<uint64_t>(static_cast<uint32_t>(tile.tile_x)) << 32 |
           static_cast<uint32_t>(tile.tile_y);
  if (event.channel == kPatternSet.name && decode(event, kPatternSet, part))
    return static_cast<uint64_t>(part.part);
  const std::hash<std::string> hash;
  fence_t fence;
  if (event.channel == kFence.name && decode(event, kFence, fence)) return hash(fence.fence_name);

  if (event.channel == kHealth.name && decode(event, kHealth, health)) return hash(health.process);
  if (event.channel == kConfig.name && decode(event, kConfig, config))
    return hash(config.config_process);
  return 0;
}

}  // namespace tread
