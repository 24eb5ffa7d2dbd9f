// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/se2.hpp"
#include "modules/simulator/core/terrain.hpp"

namespace tread::sim {

/// Random bumps in a simple polygon, convex or not; they fade out towards its border.
struct RoughRegion {
  std::vector<Eigen::Vector2d> corners;  ///< p_map [m]
  double rms = 0.02;                     ///< of the height [m]
  double shortest = 0.6;                 ///< wavelength [m]
  double longest = 2.5;                  ///< wavelength [m]
  uint64_t seed = 1;
};

/// What is wrong with a region, in words; empty if it is valid.
std::string faultOf(const RoughRegion& region);

/// The plane that supports a vehicle.
struct Bearing {
  double height = 0.0;                                 ///< at the body origin [m]
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();  ///< height gained along x and y of map [1]
};

/// The bumps of all regions: sums of plane waves with the same slope in each octave.
/** Amplitudes grow with the wavelength, as on unpaved ground (ISO 8608: w = 2). */
class RoughGround {
 public:
  explicit RoughGround(const std::vector<RoughRegion>& regions);

  bool empty() const { return patches_.empty(); }
  bool covers(const Eigen::Vector2d& p_map) const;
  /// Height of the bumps [m].
  double height(const Eigen::Vector2d& p_map) const;
  /// The same from a 5 cm raster, for the many beams of a laser [m].
  double seen(const Eigen::Vector2d& p_map) const;
  /// Upper bound of the raster's slope [1].
  double steepestSlope() const { return steepest_; }
  /// The plane that fits the bumps under both sides of a rectangle best (least squares).
  /** A rigid track bridges shorter bumps, so they lift the vehicle by less than their height. */
  Bearing bearing(const Pose2& T_map_body, const FootprintSize& contact) const;

 private:
  struct Patch {
    RoughRegion region;
    Extent extent;
    std::vector<TerrainWave> waves;
    HeightTable table;
  };
  static double heightOf(const Patch& patch, const Eigen::Vector2d& p_map);

  std::vector<Patch> patches_;
  double steepest_ = 0.0;
};

}  // namespace tread::sim
