// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/drive/drive_clock.hpp"
#include "common/log/event_log.hpp"

namespace tread {

/// Where an event of a recording is.
struct EventPlace {
  int64_t utime = 0;      ///< [us] of the robot's clock
  uint64_t position = 0;  ///< in its file, see LogReader::seek()
  uint32_t file = 0;      ///< of the recording's files
};

/// An event of a drive: `utime` is the robot's time at which its processes received it; it never
/// decreases.
struct DriveEvent : LogEvent {
  int64_t recorded = 0;   ///< [us] by the recorder's clock: any value
  uint64_t position = 0;  ///< see EventPlace
  uint32_t file = 0;
  bool wrong_time = false;  ///< its own time is impossible
  size_t restarts = 0;      ///< how often the robot's clock had restarted before it

  DriveEvent() = default;
  /// From an in-memory log, as recorded.
  DriveEvent(LogEvent event) : LogEvent(std::move(event)), recorded(utime) {}

  EventPlace place() const { return {utime, position, file}; }
};

/// Reads the events of a drive from front to back, in robot time (see DriveClock).
/** Every event is returned, whatever its time; problems of the log are counted and reported. */
class DriveReader {
 public:
  /// The files are the parts of one recording, in order. Each is opened in its turn; throws
  /// std::runtime_error with one clear line if it cannot be read.
  explicit DriveReader(std::vector<std::string> files);
  /// Events in memory, whose utime is the recorder's.
  explicit DriveReader(std::vector<LogEvent> events);

  /// The next event; false at the end.
  bool next(DriveEvent& event);
  /// Reads an event of a file again; call it only after the last event.
  bool again(const EventPlace& place, LogEvent& event);

  /// One clear line if a file is damaged; empty if all are whole.
  const std::string& damage() const { return damage_; }
  /// Other problems, one line each: clocks that were set, impossible times, foreign messages on
  /// Tread's channels. Complete after the last event.
  std::vector<std::string> notes() const;
  /// All problems in one line; empty if there are none.
  std::string problem() const;

 private:
  bool read(DriveEvent& event);
  bool readFiles(DriveEvent& event);
  bool readOn(DriveEvent& event);
  bool date(DriveEvent& event);
  std::optional<int64_t> stampOf(const LogEvent& event);

  std::vector<std::string> paths_;
  std::vector<std::unique_ptr<LogReader>> files_;  ///< those opened so far
  std::vector<LogEvent> memory_;
  size_t next_in_memory_ = 0;

  DriveClock clock_;
  std::deque<DriveEvent> pending_;  ///< read, but not dated yet
  bool ended_ = false;
  std::string damage_;
  std::map<std::string, int64_t> wrong_times_, undecodable_, impossible_;  ///< events by channel
};

/// All events of a recording, in order; throws as DriveReader does.
/** `problem` receives the problems of the log. `keep` selects events: a robot's log with all its
 * scans may not fit into memory. */
std::vector<LogEvent> readEvents(
    const std::vector<std::string>& paths, std::string& problem,
    const std::function<bool(const LogEvent&)>& keep = [](const LogEvent&) { return true; });

}  // namespace tread
