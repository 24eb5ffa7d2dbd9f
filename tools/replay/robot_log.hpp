// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/bus/lcm_bus.hpp"
#include "common/config/config_reader.hpp"
#include "common/drive/drive_log.hpp"

namespace tread::replay {

/// An event and the time at which a process of the robot received it.
struct TimedEvent {
  LogEvent event;
  int64_t heard = 0;  ///< [us] of the robot's clock, as utime; never decreases
};

/// The log of a running robot: what lcm-logger or tread-missions --log wrote.
struct RobotLog {
  std::string name;  ///< file name without folder
  std::vector<TimedEvent> events;
  std::map<std::string, std::string> configs;  ///< by process: the first CONFIG
  bool virtual_time = false;                   ///< HEALTH without UTC
  std::string problem;  ///< one clear line of what is wrong with the log, see DriveReader
  /// Messages that the log misses by seq, per channel.
  std::map<std::string, int64_t> missing;
};

/// Messages that a process counted (HEALTH) and those in the log, between its first and its last
/// HEALTH, summed over its starts.
struct Intake {
  int64_t heard = 0;  ///< messages that it received
  int64_t lost = 0;   ///< gaps in seq
  int64_t in_log = 0;
};
Intake intakeOf(const RobotLog& log, const std::string& process,
                const std::vector<std::string>& channels);
/// The counts in one line.
std::string intakeLine(const RobotLog& log, const std::string& process,
                       const std::vector<std::string>& channels);

/// Reads a log (one file, or its parts in order) without some channels, by default those that no
/// replayed process hears. Throws std::runtime_error with one clear line if it cannot be read or
/// holds nothing of ours.
RobotLog readRobotLog(const std::vector<std::string>& paths,
                      const std::vector<const char*>& without = {kScan.name, kPlanTree.name});

/// The same from events in memory, at the recorder's times; `name` stands for the log in reports.
RobotLog toRobotLog(const std::string& name, std::vector<LogEvent> events);

/// The CONFIG of a process with other values in it, KEY=VALUE with dots between sections; throws
/// std::runtime_error with one clear line if it knows no such key: CONFIG holds them all.
ConfigReader loggedConfig(const RobotLog& log, const std::string& process,
                          const std::vector<std::string>& overrides);

/// The bus of one node that receives a log: the replay sets the time, and nothing is lost.
/** The node's own messages are kept and delivered to nobody, so that it never receives its own
 * past. */
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
  /// The same where the node overhears the event, which is no input of it.
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

}  // namespace tread::replay
