// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

namespace tread::mapping {

/// One beam of a sweep.
struct Beam {
  Eigen::Vector3d end = Eigen::Vector3d::Zero();  ///< p_sensor of its return, or of its reach [m]
  double share = 0.0;  ///< 0 = at the time of the first beam, 1 = of the last
  bool hit = false;    ///< something was there; otherwise nothing up to `end`
};

/// One sweep of a range finder with the body's motion during it.
struct Sweep {
  int64_t utime = 0;                   ///< [us] of the last beam
  Eigen::Isometry3d T_map_body_first;  ///< at the time of the first beam
  Eigen::Isometry3d T_map_body_last;   ///< and of the last
  Eigen::Isometry3d T_body_sensor;
  std::vector<Beam> beams;
};

}  // namespace tread::mapping
