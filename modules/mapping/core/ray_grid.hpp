// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <octomap/OcTree.h>

namespace tread::mapping {

/// Voxels per side of a block, the unit of transfer of a scan from the grid into the tree.
inline constexpr int kBlockSide = 8;

/// One bit per voxel of a block, in the order in which an octree numbers its children: word i is
/// child i of the block, byte j of it that one's child j, bit k that one's child k; of each number,
/// bit 0 = x, bit 1 = y, bit 2 = z.
using BlockBits = std::array<uint64_t, 8>;

/// Result of one scan for a block of 8 x 8 x 8 voxels.
struct VoxelBlock {
  std::array<int, 3> low{};  ///< keys of its lowest voxel, multiples of 8
  BlockBits passed{};        ///< beams went through, and none ended
  BlockBits hit{};           ///< some beam ended
  BlockBits occupied{};      ///< set by updateTree(): passed or hit, and occupied since

  uint64_t seen(size_t word) const { return passed[word] | hit[word]; }
};

/// The voxels that the beams of one scan pass and hit: two bits per voxel, in a box of keys.
/** A beam is traced as by octomap::OcTree::computeRayKeys(), with the same arithmetic and so
 * through the same voxels (Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing",
 * Eurographics 1987), but a voxel is one number: a step to a neighbour adds its stride. */
class RayGrid {
 public:
  /// Sides of the box in voxels, each a positive multiple of 8; else std::invalid_argument.
  explicit RayGrid(const std::array<int, 3>& sides);

  /// Moves the box; discards traced beams. `low`: keys of its lowest voxel, multiples of 8,
  /// possibly beyond the tree's range.
  void moveTo(const std::array<int, 3>& low);

  /// Marks the voxels that a beam passes and, with `hit`, the one in which it ends, as far as they
  /// are in the box. Marks none if an end is beyond the tree's range.
  void trace(const octomap::OcTree& tree, const octomap::point3d& from, const octomap::point3d& to,
             bool hit);

  /// The marked blocks, in no order; clears all marks.
  /** Valid until the next call. */
  std::vector<VoxelBlock>& takeBlocks();

 private:
  /// State of a beam during tracing: position, and distances to the next borders.
  struct Step;

  int64_t bitOf(const std::array<int, 3>& key) const;
  bool contains(const std::array<int, 3>& key) const;
  void extendTo(const std::array<int, 3>& key);
  template <bool kInside>
  void walk(Step& step);
  void mark(std::vector<uint64_t>& bits, int64_t bit) {
    bits[static_cast<size_t>(bit >> 6)] |= uint64_t{1} << (bit & 63);
  }
  void takeRow(int block_y, int block_z);
  void takeBlock(const std::array<int, 3>& block, bool any_hit);
  void gather(const std::vector<uint64_t>& words, int64_t bit, BlockBits& bits) const;

  std::array<int, 3> sides_;
  std::array<int, 3> low_{};
  std::array<int64_t, 3> strides_;  // [bits] to the next voxel along x, y, z
  std::vector<uint64_t> passed_;
  std::vector<uint64_t> hit_;
  std::array<int, 3> marked_low_;  // of the voxels from the box's corner; rays may lie within
  std::array<int, 3> marked_high_;
  std::vector<VoxelBlock> blocks_;
};

}  // namespace tread::mapping
