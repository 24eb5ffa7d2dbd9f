// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tread::testing {

/// A row of the simulator's record of the truth.
struct TruthRow {
  int64_t utime = 0;  ///< [us] CLOCK_MONOTONIC
  double x = 0.0;     ///< [m]
  double y = 0.0;
  double yaw = 0.0;    ///< [rad]
  double speed = 0.0;  ///< [m/s]
  double left = 0.0;   ///< power on the motors, -1..1
  double right = 0.0;
  int contacts = 0;

  bool motorsAtZero() const { return left == 0.0 && right == 0.0; }
};

/// The whole rows that are in the file by now.
std::vector<TruthRow> readTruth(const std::string& path);

/// When the motors went to zero after a time, to stay there for at least `hold` [us]; nothing if
/// they have not yet.
std::optional<int64_t> zeroAfter(const std::vector<TruthRow>& rows, int64_t utime, int64_t hold);

}  // namespace tread::testing
