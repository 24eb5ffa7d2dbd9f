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

/// A range finder's bytes over its line: opens the line, reopens it when the device is lost, and
/// stops the device's scanning on destruction.
/** The line belongs to the caller and must outlive this. */
class ScanConnection {
 public:
  ScanConnection(Link& link, std::unique_ptr<ScanDevice> device)
      : link_(&link), device_(std::move(device)) {}
  ~ScanConnection();
  ScanConnection(ScanConnection&&) = default;
  ScanConnection& operator=(ScanConnection&&) = default;

  /// Scans completed since the last call, oldest first. Never blocks.
  std::vector<RangeScan> take(int64_t utime);
  /// Why there is no scan.
  NotedReason reason(int64_t utime) const;
  std::string shortcomings() const { return device_->shortcomings(); }
  /// Counters by name, in words.
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
