// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/mapping/core/roughness_map.hpp"

#include <algorithm>
#include <cmath>

namespace tread::mapping {
namespace {

/// Largest distance of neighbours in a profile [m].
constexpr double kGap = 0.2;
/// Shorter profiles, or those with fewer returns, do not show bumps [m].
constexpr double kShortest = 0.4;
constexpr size_t kFewest = 6;
/// Degrees of freedom from which a patch is used, and limit of its memory.
constexpr double kEnough = 12.0;
constexpr double kMost = 300.0;
/// Smaller changes do not justify a message: this share, and 1 mm.
constexpr double kNoticeableShare = 0.15;

}  // namespace

RoughnessMap::RoughnessMap(double cell_size, int side_cells)
    : cell_size_(cell_size), patches_(side_cells / kPatchCells) {}

void RoughnessMap::moveTo(CellIndex lower) {
  patches_.moveTo(patchOf(lower));
}

CellIndex RoughnessMap::patchUnder(const GroundPoint& point) const {
  const Eigen::Vector2d at = point.p_map.head<2>() / (cell_size_ * kPatchCells);
  return {static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y()))};
}

std::vector<CellIndex> RoughnessMap::take(const std::vector<GroundPoint>& points) {
  std::vector<CellIndex> changed;
  for (size_t first = 0, end = 0; first < points.size(); first = end) {
    const CellIndex index = patchUnder(points[first]);
    for (end = first + 1; end < points.size(); ++end)
      if (!(patchUnder(points[end]) == index) ||
          (points[end].p_map - points[end - 1].p_map).norm() > kGap)
        break;
    if (!patches_.contains(index)) continue;
    Patch& patch = patches_.at(index);
    takeProfile(points, first, end, patch);
    if (patch.degrees < kEnough) continue;
    const Cell cost = costOf(std::sqrt(std::max(0.0, patch.squares / patch.degrees)));
    const bool same = std::abs(cost - patch.cost) <= std::max(1.0, kNoticeableShare * patch.cost);
    if (same && patch.cost != kFree) continue;
    patch.cost = cost;
    changed.push_back({index.x * kPatchCells, index.y * kPatchCells});
  }
  return changed;
}

void RoughnessMap::takeProfile(const std::vector<GroundPoint>& points, size_t first, size_t end,
                               Patch& patch) {
  const size_t count = end - first;
  const Eigen::Vector2d chord = (points[end - 1].p_map - points[first].p_map).head<2>();
  if (count < kFewest || chord.norm() < kShortest) return;
  const Eigen::Vector2d along = chord.normalized();
  double s_sum = 0.0, z_sum = 0.0, noise = 0.0;
  for (size_t i = first; i < end; ++i) {
    s_sum += along.dot(points[i].p_map.head<2>());
    z_sum += points[i].p_map.z();
    noise += points[i].noise;
  }
  const auto n = static_cast<double>(count);
  double ss = 0.0, sz = 0.0, zz = 0.0;
  for (size_t i = first; i < end; ++i) {
    const double s = along.dot(points[i].p_map.head<2>()) - s_sum / n;
    const double z = points[i].p_map.z() - z_sum / n;
    ss += s * s;
    sz += s * z;
    zz += z * z;
  }
  const double left = zz - sz * sz / ss;
  const double kept = std::min(1.0, kMost / std::max(1.0, patch.degrees + n - 2.0));
  patch.squares = kept * (patch.squares + left - noise * (n - 2.0) / n);
  patch.degrees = kept * (patch.degrees + n - 2.0);
}

}  // namespace tread::mapping
