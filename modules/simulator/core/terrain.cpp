// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/core/terrain.hpp"

#include <algorithm>
#include <cmath>

namespace tread::sim {
namespace {

constexpr double kMostSamples = 4e6;

}  // namespace

double Terrain::height(const Eigen::Vector2d& p_map) const {
  double z = 0.0;
  for (const TerrainWave& wave : waves)
    z += wave.amplitude * std::sin(wave.k.dot(p_map) + wave.phase);
  for (const TerrainBump& bump : bumps) {
    const double ratio = (p_map - bump.centre).squaredNorm() / (bump.radius * bump.radius);
    z += bump.height * std::exp(-0.5 * ratio);
  }
  return z;
}

Eigen::Vector2d Terrain::gradient(const Eigen::Vector2d& p_map) const {
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  for (const TerrainWave& wave : waves)
    slope += wave.amplitude * std::cos(wave.k.dot(p_map) + wave.phase) * wave.k;
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
  for (const TerrainBump& bump : bumps)
    steepest += std::abs(bump.height) / bump.radius * std::exp(-0.5);
  return steepest;
}

HeightTable::HeightTable(const std::function<double(const Eigen::Vector2d&)>& height,
                         const Extent& area, double wanted_spacing)
    : low_(area.low) {
  const double spacing =
      std::max(wanted_spacing, std::sqrt((area.high - area.low).prod() / kMostSamples));
  spacing_ = spacing;
  const Eigen::Vector2d size = (area.high - area.low) / spacing;
  columns_ = static_cast<int>(std::ceil(size.x())) + 2;
  rows_ = static_cast<int>(std::ceil(size.y())) + 2;
  heights_.reserve(static_cast<size_t>(columns_) * static_cast<size_t>(rows_));
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < columns_; ++x) {
      heights_.push_back(height(low_ + spacing * Eigen::Vector2d(x, y)));
      const double along_x = x > 0 ? std::abs(at(x, y) - at(x - 1, y)) : 0.0;
      const double along_y = y > 0 ? std::abs(at(x, y) - at(x, y - 1)) : 0.0;
      steepest_ = std::max(steepest_, std::max(along_x, along_y) / spacing * std::sqrt(2.0));
    }
  }
}

double HeightTable::height(const Eigen::Vector2d& p_map) const {
  const double column = std::clamp((p_map.x() - low_.x()) / spacing_, 0.0, columns_ - 1.001);
  const double row = std::clamp((p_map.y() - low_.y()) / spacing_, 0.0, rows_ - 1.001);
  const int x = static_cast<int>(column);
  const int y = static_cast<int>(row);
  const double u = column - x;
  const double v = row - y;
  return (1.0 - v) * ((1.0 - u) * at(x, y) + u * at(x + 1, y)) +
         v * ((1.0 - u) * at(x, y + 1) + u * at(x + 1, y + 1));
}

// Friction, constant resistance and the spreads were chosen or taken from the calibration that
// tests/simulator/test_calibration.cpp repeats. The other five numbers of the first four surfaces
// were found by a simplex search (Nelder-Mead) per surface. It compared straight, left and
// hard_left, entered at steady full power, noise off, with the calibration model: squared end
// errors in x, y and yaw, and a fifth of the largest error on the path. Turns in place and the
// shipped start, stop, step and turn patterns had a small weight, so that motions not covered by
// the calibration stay close to its model. The vehicle's defaults were fixed; after a change of
// those the search must be repeated. Sand and ice are judgement, not measurement.
const std::vector<SurfaceParameters>& builtInSurfaces() {
  static const std::vector<SurfaceParameters> surfaces = {
      {"cinder", 0.75, 0.0165, 0.1794, 0.020, 0.2097, 1.183, -0.0292, {0.0149, 0.0373, 0.0474}},
      {"tarmac", 0.90, 0.0188, 0.1794, 0.010, 0.1674, 0.686, -0.0501, {0.0244, 0.0461, 0.0307}},
      {"grass", 0.80, 0.0085, 0.1793, 0.015, 0.0647, 0.507, 0.0837, {0.0418, 0.0831, 0.0147}},
      {"gravel", 0.85, 0.0297, 0.1789, 0.020, 0.1248, 0.984, 0.0948, {0.0440, 0.1220, 0.0251}},
      {"sand", 0.55, 0.0300, 0.1800, 0.030, 0.3000, 1.500, 0.0, {0.0300, 0.0800, 0.0300}},
      {"ice", 0.08, 0.0050, 0.0300, 0.005, 0.0300, 0.0, 0.0, {0.0500, 0.1500, 0.0600}},
  };
  return surfaces;
}

std::optional<SurfaceParameters> builtInSurface(const std::string& name) {
  for (const SurfaceParameters& surface : builtInSurfaces()) {
    if (surface.name == name) return surface;
  }
  return std::nullopt;
}

}  // namespace tread::sim
