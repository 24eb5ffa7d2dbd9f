// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/drive/robot_log.hpp"
#include "tools/lab/missions/mission.hpp"
#include "tools/lab/missions/robot_system.hpp"

namespace tread::samples {

/// The first seconds of a mission with its complete bus recorded in memory; `prepare` may disturb
/// its devices.
inline std::vector<LogEvent> drivenLog(
    double seconds, const FaultPlan& faults = {}, const char* rule = "collective",
    const std::function<void(missions::RobotSystem&)>& prepare = [](missions::RobotSystem&) {}) {
  constexpr int64_t kTick = 50'000;
  const missions::MissionWorld world = missions::makeMissionWorld(14, {0.65, 0.65, 0.34});
  missions::RobotSystem system(missions::readRobot(TREAD_SOURCE_DIR "/config/robots/teodor"),
                               world.description, world.T_map_start, 14, rule, faults);
  std::vector<LogEvent> events;
  system.bus().setTap([&](int64_t utime, const char* channel, const uint8_t* bytes, size_t size) {
    if (channel == std::string(kScan.name) || channel == std::string(kPlanTree.name)) return;
    events.push_back({utime, channel, {bytes, bytes + size}});
  });
  prepare(system);
  missions::Operator person(system.bus().outside(), world.T_map_goal);
  const int64_t start = system.bus().now();
  for (int64_t tick = 1; static_cast<double>(tick * kTick) * 1e-6 < seconds; ++tick) {
    system.bus().runUntil(start + tick * kTick);
    person.step(system.bus().now());
  }
  return events;
}

/// The same, driven once for all processes of a test program, because ctest starts each test case
/// separately.
/** Stored next to the program, until the program or the robot's configuration is newer. */
inline std::vector<LogEvent> keptDrivenLog(double seconds) {
  namespace fs = std::filesystem;
  const fs::path program = fs::read_symlink("/proc/self/exe");
  fs::file_time_type newest = fs::last_write_time(program);
  for (const char* folder : {"robots/teodor", "patterns"})
    for (const auto& file : fs::directory_iterator(fs::path(TREAD_SOURCE_DIR) / "config" / folder))
      newest = std::max(newest, file.last_write_time());
  const std::string kept = program.string() + ".lcmlog";
  const int lock = open((kept + ".lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  if (lock < 0 || flock(lock, LOCK_EX) != 0)
    throw std::runtime_error(kept + ".lock: cannot be locked");
  if (!fs::exists(kept) || fs::last_write_time(kept) <= newest) {
    {
      LogWriter log(kept + ".part");
      for (const LogEvent& event : drivenLog(seconds))
        log.write(event.utime, event.channel, event.bytes.data(), event.bytes.size());
      log.flush();
    }
    fs::rename(kept + ".part", kept);
  }
  close(lock);
  std::string problem;
  return readEvents({kept}, problem);
}

/// Modifies the messages of a channel for which `change` returns true.
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
