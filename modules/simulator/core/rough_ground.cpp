// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/core/rough_ground.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace tread::sim {
namespace {

constexpr int kWaves = 40;
constexpr double kFade = 0.5;      // distance from the border to full height [m]
constexpr double kSpacing = 0.05;  // of the raster [m]
constexpr int kAlong = 11;         // points along each side of a supporting rectangle

/// From a point of a polygon to its border [m].
double distanceToBorder(const std::vector<Eigen::Vector2d>& corners, const Eigen::Vector2d& p) {
  double nearest = 1e9;
  for (size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const Eigen::Vector2d side = corners[i] - corners[j];
    const double share = std::clamp((p - corners[j]).dot(side) / side.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (p - corners[j] - share * side).norm());
  }
  return nearest;
}

/// Wavelengths evenly distributed over the octaves, directions and phases at random.
std::vector<TerrainWave> wavesOf(const RoughRegion& region) {
  std::mt19937_64 random(region.seed * 0x9E3779B97F4A7C15ULL + 1);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1.0p-53; };
  std::vector<TerrainWave> waves(kWaves);
  double squares = 0.0;
  for (int i = 0; i < kWaves; ++i) {
    const double octave = (i + uniform()) / kWaves;
    const double length = region.shortest * std::pow(region.longest / region.shortest, octave);
    const double direction = 2.0 * kPi * uniform();
    const double k = 2.0 * kPi / length;
    waves[static_cast<size_t>(i)] = {length,
                                     k * Eigen::Vector2d(std::cos(direction), std::sin(direction)),
                                     2.0 * kPi * uniform()};
    squares += 0.5 * length * length;
  }
  for (TerrainWave& wave : waves) wave.amplitude *= region.rms / std::sqrt(squares);
  return waves;
}

}  // namespace

std::string faultOf(const RoughRegion& region) {
  if (region.corners.size() < 3) return "needs at least three corners";
  if (!(region.shortest > 0.0 && region.shortest < region.longest))
    return "the shortest wavelength must be above 0 and below the longest";
  return "";
}

RoughGround::RoughGround(const std::vector<RoughRegion>& regions) {
  for (const RoughRegion& region : regions) {
    if (!faultOf(region).empty()) continue;  // the world refuses it with a message
    Patch patch{region, extentOf(region.corners), wavesOf(region), {}};
    patch.table =
        HeightTable([&](const auto& p) { return heightOf(patch, p); }, patch.extent, kSpacing);
    steepest_ += patch.table.steepestSlope();
    patches_.push_back(std::move(patch));
  }
}

bool RoughGround::covers(const Eigen::Vector2d& p_map) const {
  return std::any_of(patches_.begin(), patches_.end(), [&](const Patch& patch) {
    return patch.extent.contains(p_map) && insidePolygon(patch.region.corners, p_map);
  });
}

double RoughGround::heightOf(const Patch& patch, const Eigen::Vector2d& p_map) {
  if (!patch.extent.contains(p_map) || !insidePolygon(patch.region.corners, p_map)) return 0.0;
  const double in = std::min(1.0, distanceToBorder(patch.region.corners, p_map) / kFade);
  double z = 0.0;
  for (const TerrainWave& wave : patch.waves)
    z += wave.amplitude * std::sin(wave.k.dot(p_map) + wave.phase);
  return in * in * (3.0 - 2.0 * in) * z;
}

double RoughGround::height(const Eigen::Vector2d& p_map) const {
  double z = 0.0;
  for (const Patch& patch : patches_) z += heightOf(patch, p_map);
  return z;
}

double RoughGround::seen(const Eigen::Vector2d& p_map) const {
  double z = 0.0;
  for (const Patch& patch : patches_)
    if (patch.extent.contains(p_map)) z += patch.table.height(p_map);
  return z;
}

Bearing RoughGround::bearing(const Pose2& T_map_body, const FootprintSize& contact) const {
  const double middle = 0.5 * (contact.front - contact.rear);
  double sum = 0.0, along = 0.0, across = 0.0, along_square = 0.0;
  for (int i = 0; i < kAlong; ++i) {
    const double x = contact.length() * (static_cast<double>(i) / (kAlong - 1) - 0.5);
    for (const double y : {-contact.half_width, contact.half_width}) {
      const double z = height(T_map_body * Eigen::Vector2d(middle + x, y));
      sum += z;
      along += x * z;
      across += y * z;
      along_square += x * x;
    }
  }
  constexpr double kPoints = 2.0 * kAlong;
  const Eigen::Vector2d slope(along / along_square,
                              across / (kPoints * contact.half_width * contact.half_width));
  const double c = std::cos(T_map_body.yaw), s = std::sin(T_map_body.yaw);
  return {sum / kPoints - slope.x() * middle,
          {c * slope.x() - s * slope.y(), s * slope.x() + c * slope.y()}};
}

}  // namespace tread::sim
