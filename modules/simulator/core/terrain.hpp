// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "modules/simulator/core/obstacle.hpp"

namespace tread::sim {

/// A plane wave of the ground: amplitude x sin(k . p + phase).
struct TerrainWave {
  double amplitude = 0.0;                       ///< [m]
  Eigen::Vector2d k = Eigen::Vector2d::Zero();  ///< wave vector, 2 pi over wavelength [rad/m]
  double phase = 0.0;                           ///< [rad]
};

/// A round hill or, with negative height, a hollow: height x exp(-r^2 / (2 radius^2)).
struct TerrainBump {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< p_map [m]
  double height = 0.0;                               ///< [m]
  double radius = 1.0;                               ///< [m]
};

/// A smooth height field: waves and bumps on a level plane.
struct Terrain {
  std::vector<TerrainWave> waves;
  std::vector<TerrainBump> bumps;

  bool flat() const { return waves.empty() && bumps.empty(); }
  /// Height of the ground [m].
  double height(const Eigen::Vector2d& p_map) const;
  /// Height gained per metre along x and y of the map [1].
  Eigen::Vector2d gradient(const Eigen::Vector2d& p_map) const;
  /// Upper bound of the slope [1]: the sum of the parts' largest slopes.
  double steepestSlope() const;
};

/// Heights on a square raster, for the many look-ups of a laser scan.
class HeightTable {
 public:
  HeightTable() = default;
  /// Samples heights over an area; outside of it the border's height continues. Very large areas
  /// are sampled more coarsely.
  HeightTable(const std::function<double(const Eigen::Vector2d&)>& height, const Extent& area,
              double spacing);

  bool empty() const { return heights_.empty(); }
  /// Height between the samples, bilinear [m].
  double height(const Eigen::Vector2d& p_map) const;
  /// Largest slope between neighbouring samples along x or y, times sqrt(2): bounds all directions
  /// [1].
  double steepestSlope() const { return steepest_; }

 private:
  double at(int x, int y) const {
    return heights_[static_cast<size_t>(y) * static_cast<size_t>(columns_) +
                    static_cast<size_t>(x)];
  }

  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  double spacing_ = 0.25;
  int columns_ = 0;
  int rows_ = 0;
  double steepest_ = 0.0;
  std::vector<double> heights_;  ///< columns x rows [m]
};

/// Spread of the motion between executions of 1 s.
struct MotionSpread {
  double forward = 0.0;  ///< sig_f, relative, of the forward gain [1]
  double yaw = 0.0;      ///< sig_psi, relative, of the yaw gain [1]
  double heading = 0.0;  ///< sig_del, of the direction of motion against the body axis [rad]
};

/// Properties of a kind of ground for a track.
struct SurfaceParameters {
  std::string name;
  double friction = 0.8;  ///< ratio of maximum shear to normal force [1]
  /// Displacement of the ground at which shear along the track saturates [m]
  double shear_displacement = 0.03;
  double lateral_displacement = 0.1;  ///< the same across the track [m]
  double resistance_constant = 0.01;  ///< rolling resistance over normal force at any speed [1]
  double resistance_viscous = 0.05;   ///< rolling resistance over normal force per speed [s/m]
  double scrub_resistance = 1.0;      ///< against sideways slip, over normal force and speed [s/m]
  double pressure_offset = 0.0;       ///< centre of pressure ahead of the patch's centre [m]
  MotionSpread spread;
};

/// The built-in surfaces: cinder, tarmac, grass, gravel, sand, ice.
const std::vector<SurfaceParameters>& builtInSurfaces();

/// A built-in surface by name; nullopt if there is none of that name.
std::optional<SurfaceParameters> builtInSurface(const std::string& name);

}  // namespace tread::sim
