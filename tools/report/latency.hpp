// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "common/log/event_log.hpp"

namespace tread::report {

/// Times that something took [ms].
class Durations {
 public:
  void add(double milliseconds) { values_.push_back(milliseconds); }
  size_t count() const { return values_.size(); }
  /// The value that a share (0..1) does not exceed; NaN if there is none.
  double quantile(double share) const;

 private:
  std::vector<double> values_;
};

/// How long messages wait for each other, by the times at which the logger received them.
/** INS to set: from the INS message that passes the end of an execution to the first part of the
 * set that was learned from it. Set to plan: from the last part of a set's first appearance to the
 * first PLAN made with it. Scan to tile: from SCAN to the next MAP message that holds it. */
class Latencies {
 public:
  void add(const LogEvent& event);

  const Durations& insToSet() const { return ins_to_set_; }
  const Durations& setToPlan() const { return set_to_plan_; }
  const Durations& scanToTile() const { return scan_to_tile_; }

 private:
  struct Received {
    int64_t utime;     ///< [us] of the message
    int64_t received;  ///< [us] by the logger
  };
  void hear(const learning_t& message);
  void hear(const pattern_set_part_t& message, int64_t received);

  std::deque<Received> ins_;                 ///< of the last seconds
  std::deque<Received> scans_;               ///< not yet in a tile
  std::map<int64_t, int64_t> first_part_;    ///< by version: when its first part came
  std::map<int64_t, int64_t> awaited_sets_;  ///< by version: when the INS came that allowed it
  std::map<int64_t, int64_t> unplanned_;     ///< by version: when it was complete
  std::map<int64_t, int> parts_;             ///< by version: parts so far
  int64_t newest_version_ = 0;
  Durations ins_to_set_, set_to_plan_, scan_to_tile_;
};

}  // namespace tread::report
