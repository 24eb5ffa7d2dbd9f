// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include <Eigen/Core>

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
  /// A slope that is nowhere exceeded [1]: the sum of the parts' largest slopes.
  double steepestSlope() const;
};

}  // namespace tread::sim
