// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

namespace tread::importer {

/// What sessions.csv says about one recording.
struct Session {
  std::string name;
  std::string robot;
  std::string surface;
  double wheel_radius = 0.0;  ///< [m]
  double baseline = 0.0;      ///< [m] that turns (v, w) commands into wheel speeds
  double pose_lag = 0.0;      ///< [s] poses are logged this much after they were measured
  bool lag_kept = false;      ///< they stay there; pose_lag is 0 then
  double pose_rate = 0.0;     ///< [Hz]
  double imu_sign = 1.0;      ///< of the gyro in raw files, so that + is counter-clockwise
  bool absolute_attitude =
      false;        ///< roll and pitch are those in the map, not changes since a step's start
  size_t rows = 0;  ///< of the steps file
};

/// The row of a session; throws ImportError with one clear line.
Session readSession(const std::string& sessions_path, const std::string& name);

}  // namespace tread::importer
