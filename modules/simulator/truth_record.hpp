// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

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

/// A row of such a record.
struct TruthRow {
  int64_t utime = 0;                      ///< [us]
  Pose2 T_map_body;                       ///< yaw unwrapped
  double speed = 0.0;                     ///< forward [m/s]
  std::array<double, 2> power{0.0, 0.0};  ///< on the motors: left, right, -1..1
  std::string surface;
  int contacts = 0;       ///< so far
  double distance = 0.0;  ///< driven so far [m]

  bool motorsAtZero() const { return power[0] == 0.0 && power[1] == 0.0; }
};

/// The whole rows that are in a record by now; a half written last one is left out. Throws
/// std::runtime_error with one clear line if the file is not there or no such record.
std::vector<TruthRow> readTruthRecord(const std::string& path);

}  // namespace tread::sim
