// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/drive/drive_timeline.hpp"

namespace tread::view {

/// Data from before a page was opened: events, pattern errors, path, battery.
class History {
 public:
  /// Keeps at least the newest `most` of each list, and at most twice as many.
  explicit History(size_t most = SIZE_MAX / 2) : most_(most) {}
  void take(const LogEvent& event);
  /// All of it as JSON.
  std::string whole() const;
  /// Entries since the last call, as JSON; empty if there are none.
  std::string news();

 private:
  struct Pattern {
    int64_t utime;
    learning_t ended;
  };
  struct Sample {
    int64_t utime;
    double a, b;
  };
  /// Length of each list.
  struct Mark {
    size_t events = 0, patterns = 0, way = 0, battery = 0;
    bool operator==(const Mark& other) const {
      return events == other.events && patterns == other.patterns && way == other.way &&
             battery == other.battery;
    }
  };
  void forgetOldest();
  Mark end() const { return {events_.size(), patterns_.size(), way_.size(), battery_.size()}; }
  std::string since(const Mark& mark, bool from_start) const;

  size_t most_;
  EventTeller teller_;
  std::vector<Event> events_;
  std::vector<Pattern> patterns_;
  std::vector<Sample> way_;      ///< x, y [m] in map
  std::vector<Sample> battery_;  ///< [V]
  Mark told_;
};

}  // namespace tread::view
