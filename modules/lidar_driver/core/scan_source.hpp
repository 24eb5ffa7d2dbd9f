// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "modules/lidar_driver/core/range_scan.hpp"

namespace tread::lidar {

/// Where scans come from: a device's library on the robot, the simulated laser in virtual time.
/** The library insists on a socket and a clock of its own, so that this is the interface behind it.
 */
class ScanSource {
 public:
  virtual ~ScanSource() = default;
  /// Scans that were completed since the last call, oldest first. Never blocks.
  virtual std::vector<RangeScan> take(int64_t utime) = 0;
  /// What is wrong with the device, in one line; empty if nothing is known to be.
  virtual std::string problem() const = 0;
  /// Seconds since the device's library last came back; 0 for sources that cannot hang.
  virtual double stuckFor() const { return 0.0; }
  /// Ends the device's own thread. False if it hangs for good: then the process must end without
  /// the destructors of static objects, which that thread may use.
  virtual bool end() { return true; }
};

}  // namespace tread::lidar
