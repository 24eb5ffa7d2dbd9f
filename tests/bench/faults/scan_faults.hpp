// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "modules/lidar_driver/core/range_scan.hpp"
#include "tests/bench/faults/fault_schedule.hpp"

namespace tread::faults {

/// Faults of a range finder, before its driver gets a scan.
class ScanFaults {
 public:
  void begin(const Fault& fault) { fault_ = fault; }
  void end() { fault_.reset(); }
  void disturb(lidar::RangeScan& scan);

 private:
  void repeat(lidar::RangeScan& scan, int64_t utime);

  std::optional<Fault> fault_;
  std::deque<lidar::RangeScan> past_;  ///< unaltered
  int frame_ = 0;
};

}  // namespace tread::faults
