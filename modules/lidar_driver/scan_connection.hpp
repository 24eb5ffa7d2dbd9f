// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/link/link.hpp"
#include "modules/lidar_driver/core/scan_device.hpp"

namespace tread::lidar {

/// A range finder's bytes over its line: opens the line, opens it anew where the device is lost,
/// and ends the device's scanning when this goes.
/** The line is the owner's and outlives it. */
class ScanConnection {
 public:
  ScanConnection(Link& link, std::unique_ptr<ScanDevice> device)
      : link_(&link), device_(std::move(device)) {}
  ~ScanConnection();
  ScanConnection(ScanConnection&&) = default;
  ScanConnection& operator=(ScanConnection&&) = default;

  /// Scans that were completed since the last call, oldest first. Never blocks.
  std::vector<RangeScan> take(int64_t utime);
  /// Why no scan comes.
  NotedReason reason(int64_t utime) const;
  std::string shortcomings() const { return device_->shortcomings(); }
  /// What was counted, by its name in words.
  std::map<std::string, int64_t> counters() const;

 private:
  std::string linkProblem() const;
  bool keepOpen(int64_t utime);
  void read(int64_t utime);

  Link* link_;
  std::unique_ptr<ScanDevice> device_;
  bool was_open_ = false;
  bool scanned_ = false;   ///< in this connection
  int64_t open_from_ = 0;  ///< not before this time
  int64_t last_open_ = 0;
  int64_t connections_ = 0;
};

}  // namespace tread::lidar
