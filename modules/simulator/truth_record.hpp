// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <ostream>

#include "modules/simulator/core/robot.hpp"

namespace tread::sim {

/// What really happened, as CSV for reports and tests; the robot's processes never see it.
/** One row when the power on the motors changes, else every 20 ms:
 * utime_us,x_m,y_m,yaw_rad,v_mps,left,right,surface,contacts,distance_m. Yaw is unwrapped, power
 * is what the controller puts on the motors (-1..1). */
class TruthRecord {
 public:
  /// Writes the header; the stream is the owner's and outlives the record.
  explicit TruthRecord(std::ostream& out);

  void note(const RobotTruth& truth, const std::array<double, 2>& power);

 private:
  std::ostream& out_;
  std::array<double, 2> power_{0.0, 0.0};
  int64_t last_row_ = INT64_MIN;
  int64_t last_flush_ = INT64_MIN;
};

}  // namespace tread::sim
