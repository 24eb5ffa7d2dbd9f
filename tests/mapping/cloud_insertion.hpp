// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include <octomap/OcTree.h>

#include "modules/mapping/core/tree_update.hpp"

namespace tread::mapping {

/// A cloud as in octomap::OcTree::insertPointCloud() with discretize = true: one beam for all
/// points of a voxel, to the voxel's centre; beyond max_range it passes without a hit.
class CloudInsertion {
 public:
  /// The grid covers max_range [m] around any point of a voxel.
  CloudInsertion(double resolution, double max_range)
      : max_range_(max_range),
        half_((static_cast<int>(max_range / resolution) + 4 + kBlockSide) / kBlockSide *
              kBlockSide),
        grid_({2 * half_, 2 * half_, 2 * half_}),
        seen_(size_t{1} << kSeenBits, kNoKey) {}

  void insert(octomap::OcTree& tree, const octomap::Pointcloud& cloud,
              const octomap::point3d& origin) {
    const octomap::OcTreeKey at = tree.coordToKey(origin);
    const auto low = [&](unsigned axis) { return (at[axis] / kBlockSide) * kBlockSide - half_; };
    grid_.moveTo({low(0), low(1), low(2)});
    std::fill(seen_.begin(), seen_.end(), kNoKey);
    for (size_t i = 0; i < cloud.size(); ++i) {
      const octomap::OcTreeKey key = tree.coordToKey(cloud[static_cast<unsigned>(i)]);
      if (isNew(key)) trace(tree, origin, tree.keyToCoord(key));
    }
    update_(tree, grid_.takeBlocks());
  }

 private:
  static constexpr unsigned kSeenBits = 15;
  static constexpr uint64_t kNoKey = ~uint64_t{0};

  /// It may be wrong about old ones: a forgotten voxel is traced again, with the same result.
  bool isNew(const octomap::OcTreeKey& key) {
    const uint64_t number = uint64_t{key[0]} | uint64_t{key[1]} << 16 | uint64_t{key[2]} << 32;
    uint64_t& seen = seen_[number * 0x9E3779B97F4A7C15u >> (64 - kSeenBits)];
    if (seen == number) return false;
    seen = number;
    return true;
  }

  void trace(const octomap::OcTree& tree, const octomap::point3d& origin,
             const octomap::point3d& point) {
    if ((point - origin).norm() <= max_range_) return grid_.trace(tree, origin, point, true);
    const octomap::point3d direction = (point - origin).normalized();
    grid_.trace(tree, origin, origin + direction * static_cast<float>(max_range_), false);
  }

  double max_range_;
  int half_;
  RayGrid grid_;
  TreeUpdate update_;
  std::vector<uint64_t> seen_;
};

/// A complete tree, for bitwise comparison.
inline std::string bytesOf(const octomap::OcTree& tree) {
  std::ostringstream bytes;
  tree.writeData(bytes);
  return bytes.str();
}

}  // namespace tread::mapping
