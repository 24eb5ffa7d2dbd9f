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

/// One scan of a level range finder, seen from above and sorted by bearing.
/** Points are in the plane of the sensor: its position in map is the origin, its x axis points
 * forward. Returns from the robot itself and from the ground are left out. */
class ScanView {
 public:
  /// Number of bearings into which points are sorted.
  static constexpr int kBins = 180;

  /// `robot`: its outline; `height` [m] above which a return is not its own.
  ScanView(const Scan& scan, const FootprintSize& robot, double height);

  int64_t utime() const { return utime_; }
  const PlaneMove& T_map_sensor() const { return T_map_sensor_; }
  const std::vector<Eigen::Vector2d>& points() const { return points_; }
  /// The points of another view in the plane that this one observed: higher or lower points were
  /// invisible to it, and the ground is hit elsewhere as soon as the robot pitches. None if most
  /// are outside of it.
  std::vector<Eigen::Vector2d> inPlane(const ScanView& other, size_t at_most) const;

  /// Relation of a point of another scan to this one.
  enum class Fit {
    kUnknown,  ///< this one did not look in that direction
    kMatch,
    kHidden,  ///< behind its returns, or beyond its range
    kMiss     ///< it saw free space there
  };
  Fit fit(const Eigen::Vector2d& p_sensor) const;

  /// Points of this view that a later scan must hit, and how many of them it missed.
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
  std::array<double, kBins> seen_{};  ///< free range at each bearing [m]; infinite: not observed
};

}  // namespace tread::mapping
