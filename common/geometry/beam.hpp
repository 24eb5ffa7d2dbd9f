// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <Eigen/Core>

namespace tread {

/// One beam of a scan.
struct Beam {
  Eigen::Vector3d end = Eigen::Vector3d::Zero();  ///< p_sensor of its return, or of its reach [m]
  double share = 0.0;  ///< 0 = at the time of the first beam, 1 = of the last
  bool hit = false;    ///< an object was hit; otherwise the beam is free up to `end`
};

}  // namespace tread
