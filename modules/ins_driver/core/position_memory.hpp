// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "modules/ins_driver/core/device_epoch.hpp"

namespace tread::ins {

/// A measured or extrapolated position of the reference point in the map.
struct PointInMap {
  Eigen::Vector3d p_map = Eigen::Vector3d::Constant(kUnmeasured);  ///< z NaN: no altitude [m]
  Eigen::Vector3d std = Eigen::Vector3d::Constant(kUnmeasured);    ///< along map axes [m]
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();                ///< which point of the body [m]
  int satellites = -1;                                             ///< -1 unknown
};

/// The last measured position, to bridge the short time to a later attitude.
class PositionMemory {
 public:
  explicit PositionMemory(int64_t hold_us) : hold_us_(hold_us) {}

  /// `velocity`: of the point along map x and y [m/s], if the device reported it; otherwise it is
  /// derived from the previous position, if that is at most 250 ms old.
  void add(int64_t utime, const PointInMap& point, const std::optional<Eigen::Vector2d>& velocity,
           double velocity_std);
  /// The point extrapolated to a later time, at most by the hold time, with its velocity; height is
  /// kept.
  /** The standard deviation grows by that of the velocity times the age. */
  std::optional<PointInMap> at(int64_t utime) const;
  void clear() { newest_.reset(); }

 private:
  int64_t hold_us_;
  std::optional<PointInMap> newest_;
  int64_t utime_ = 0;
  std::optional<Eigen::Vector2d> velocity_;
  double velocity_std_ = kUnmeasured;
};

}  // namespace tread::ins
