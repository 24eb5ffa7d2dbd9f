// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/core/terrain.hpp"

#include <cmath>

namespace tread::sim {

double Terrain::height(const Eigen::Vector2d& p_map) const {
  double z = 0.0;
  for (const TerrainWave& wave : waves) {
    z += wave.amplitude * std::sin(wave.k.dot(p_map) + wave.phase);
  }
  for (const TerrainBump& bump : bumps) {
    const double ratio = (p_map - bump.centre).squaredNorm() / (bump.radius * bump.radius);
    z += bump.height * std::exp(-0.5 * ratio);
  }
  return z;
}

Eigen::Vector2d Terrain::gradient(const Eigen::Vector2d& p_map) const {
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  for (const TerrainWave& wave : waves) {
    slope += wave.amplitude * std::cos(wave.k.dot(p_map) + wave.phase) * wave.k;
  }
  for (const TerrainBump& bump : bumps) {
    const Eigen::Vector2d from_centre = p_map - bump.centre;
    const double square = bump.radius * bump.radius;
    slope -=
        bump.height * std::exp(-0.5 * from_centre.squaredNorm() / square) / square * from_centre;
  }
  return slope;
}

double Terrain::steepestSlope() const {
  double steepest = 0.0;
  for (const TerrainWave& wave : waves) steepest += std::abs(wave.amplitude) * wave.k.norm();
  // A bump is steepest at r = radius.
  for (const TerrainBump& bump : bumps) {
    steepest += std::abs(bump.height) / bump.radius * std::exp(-0.5);
  }
  return steepest;
}

}  // namespace tread::sim
