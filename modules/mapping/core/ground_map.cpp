// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/mapping/core/ground_map.hpp"

#include <algorithm>
#include <cmath>

namespace tread::mapping {
namespace {

/// Limit of a patch's memory, in stances of full weight, so that a drifting height is followed.
constexpr double kMemory = 10.0;
/// Smaller changes of height and uncertainty do not justify a new classification of columns [m].
constexpr double kNoticeable = 0.02;

CellIndex patchOf(CellIndex cell) {
  return {floorDivide(cell.x, GroundMap::kPatchCells), floorDivide(cell.y, GroundMap::kPatchCells)};
}

}  // namespace

std::optional<GroundPlane> planeUnder(const Eigen::Isometry3d& T_map_body) {
  const Eigen::Vector3d up = T_map_body.linear().col(2);
  if (!(up.z() > 0.5)) return std::nullopt;
  return GroundPlane{T_map_body.translation(), -up.head<2>() / up.z()};
}

GroundMap::GroundMap(const GroundMapConfig& config, double cell_size, int side_cells)
    : config_(config), cell_size_(cell_size), patches_(side_cells / kPatchCells) {}

void GroundMap::moveTo(CellIndex lower) {
  patches_.moveTo(patchOf(lower));
}

Eigen::Vector2d GroundMap::centreOf(CellIndex patch) const {
  const double side = kPatchCells * cell_size_;
  return {(patch.x + 0.5) * side, (patch.y + 0.5) * side};
}

std::vector<CellIndex> GroundMap::learn(const GroundPlane& plane) {
  std::vector<CellIndex> moved;
  for (size_t i = 0; i < patches_.size(); ++i) {
    const CellIndex index = patches_.indexOf(i);
    if (refine(patches_[i], centreOf(index), plane))
      moved.push_back({index.x * kPatchCells, index.y * kPatchCells});
  }
  return moved;
}

bool GroundMap::refine(Patch& patch, const Eigen::Vector2d& centre,
                       const GroundPlane& plane) const {
  const Eigen::Vector2d offset = centre - plane.p_map.head<2>();
  const double d = offset.norm();
  const double from_slope = config_.slope_noise * d;
  const double from_curvature = 0.5 * config_.curvature * d * d;
  const double noise = config_.height_noise;
  const double weight =
      1.0 / (noise * noise + from_slope * from_slope + from_curvature * from_curvature);
  patch.weight = std::min(patch.weight, kMemory / (noise * noise)) + weight;
  const double gain = weight / patch.weight;
  patch.z += gain * (plane.p_map.z() + plane.slope.dot(offset) - patch.z);
  patch.slope += gain * (plane.slope - patch.slope);
  patch.nearest = std::min(patch.nearest, d);
  const bool moved = std::abs(patch.z - patch.told_z) > kNoticeable ||
                     config_.slope_doubt * (patch.told_nearest - patch.nearest) > kNoticeable;
  if (moved) {
    patch.told_z = patch.z;
    patch.told_nearest = patch.nearest;
  }
  return moved;
}

GroundHeight GroundMap::at(CellIndex cell) const {
  const CellIndex index = patchOf(cell);
  const Patch& patch = patches_.at(index);
  const Eigen::Vector2d centre((cell.x + 0.5) * cell_size_, (cell.y + 0.5) * cell_size_);
  return {patch.z + patch.slope.dot(centre - centreOf(index)), config_.slope_doubt * patch.nearest};
}

}  // namespace tread::mapping
