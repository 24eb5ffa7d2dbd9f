// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "common/geometry/se2.hpp"
#include "modules/mapping/core/occupancy_map.hpp"

namespace tread::mapping {

/// A rotation, reflection and translation in the plane.
using PlaneMove = Eigen::Isometry2d;

/// What one scan of a level range finder showed, seen from above and sorted by bearing.
/** Points lie in the plane of the sensor: its position in map is the origin, its x axis points
 *  forward. Returns from the robot itself and from the ground are left out. */
class ScanView {
 public:
  /// Bearings that points are sorted by.
  static constexpr int kBins = 180;

  /// `robot`: its outline; `height` [m] above which a return is none of its own.
  ScanView(const Scan& scan, const FootprintSize& robot, double height);

  int64_t utime() const { return utime_; }
  const PlaneMove& T_map_sensor() const { return T_map_sensor_; }
  const std::vector<Eigen::Vector2d>& points() const { return points_; }
  /// The points of another view that lie in the plane which this one looked at: what is higher or
  /// lower it could not see, and ground is seen elsewhere as soon as the robot pitches. None if
  /// most lie elsewhere.
  std::vector<Eigen::Vector2d> inPlane(const ScanView& other, size_t at_most) const;

  /// How a point of another scan lies to this one's.
  enum class Fit {
    kUnknown,  ///< this one did not look there
    kMatch,
    kHidden,  ///< behind what it saw, or where its range ends
    kMiss     ///< it saw nothing there
  };
  Fit fit(const Eigen::Vector2d& p_sensor) const;

  /// Points of this view that a later scan must have hit, and through how many of them it saw.
  struct SeenThrough {
    int expected = 0;
    int through = 0;
  };
  SeenThrough seenThrough(const Scan& later) const;

 private:
  static int binOf(const Eigen::Vector2d& p_sensor);
  void sortIn(std::vector<std::pair<int, Eigen::Vector3d>> hits);

  int64_t utime_;
  PlaneMove T_map_sensor_ = PlaneMove::Identity();
  Eigen::Isometry3d T_sensor_map_;           // in space
  std::vector<Eigen::Vector2d> points_;      // by bin
  std::vector<Eigen::Vector3d> p_map_;       // the same points
  std::array<uint32_t, kBins + 1> first_{};  // point of each bin
  std::array<bool, kBins> looked_{};
  std::array<double, kBins> seen_{};  ///< to where at each bearing [m]; infinite: it did not look
};

}  // namespace tread::mapping
