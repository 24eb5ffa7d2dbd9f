// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/missions/mission_world.hpp"
#include "tools/missions/operator.hpp"
#include "tools/missions/robot_system.hpp"
#include "tools/replay/robot_log.hpp"

namespace tread::samples {

/// The first seconds of a mission, everything on its bus recorded in memory.
inline std::vector<LogEvent> drivenLog(double seconds, const FaultPlan& faults = {}) {
  constexpr int64_t kTick = 50'000;
  const missions::MissionWorld world = missions::makeMissionWorld(14);
  missions::RobotSystem system(missions::readRobot(TREAD_SOURCE_DIR "/config/robots/teodor"),
                               world.description, world.T_map_start, 14, "collective", faults);
  std::vector<LogEvent> events;
  system.bus().setTap([&](int64_t utime, const char* channel, const uint8_t* bytes, size_t size) {
    if (channel == std::string(kScan.name) || channel == std::string(kPlanTree.name)) return;
    events.push_back({utime, channel, {bytes, bytes + size}});
  });
  missions::Operator person(system.bus().outside(), world.T_map_goal);
  const int64_t start = system.bus().now();
  for (int64_t tick = 1; static_cast<double>(tick * kTick) * 1e-6 < seconds; ++tick) {
    system.bus().runUntil(start + tick * kTick);
    person.step(system.bus().now());
  }
  return events;
}

/// Changes the messages of a channel for which `change` returns true.
template <class Message>
void rewrite(std::vector<LogEvent>& events, const Channel<Message>& channel,
             const std::function<bool(Message&)>& change) {
  for (LogEvent& event : events) {
    Message message;
    if (!decode(event, channel, message) || !change(message)) continue;
    event.bytes = encoded(message);
  }
}

}  // namespace tread::samples
