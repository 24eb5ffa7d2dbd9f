// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <octomap/OcTree.h>

#include "modules/mapping/core/ray_grid.hpp"

namespace tread::mapping {

/// Inserts the blocks of one scan into an octree and returns which of their voxels are now
/// occupied.
/** The tree equals, byte for byte, that after octomap::OcTree::updateNode(key, hit) for each voxel
 * of the blocks, hits and misses in any order: pruned wherever eight children are equal, inner
 * nodes up to date.
 *  1. Blocks are in Morton order: the children of a node are consecutive, so one descent visits
 *     each node once and prunes it, or sets its value, when all its children are done.
 *  2. A childless node below which every voxel gets the same update is updated itself, as eight
 *     equal children would be pruned. So observed free space costs no nodes.
 *  3. Nodes at the clamping limit of their update stay as they are, as in updateNode().
 * Does not support the tree's change detection. Blocks are sorted; no block may occur twice. */
class TreeUpdate {
 public:
  void operator()(octomap::OcTree& tree, std::vector<VoxelBlock>& blocks);

 private:
  using Node = octomap::OcTreeNode;
  /// A block by its Morton code.
  using Entry = std::pair<uint64_t, VoxelBlock*>;

  void makeRoot(const VoxelBlock& block);
  bool inner(Node* node, bool fresh, unsigned depth, const Entry* first, const Entry* last);
  bool block(Node* node, bool fresh, VoxelBlock& block);
  template <unsigned kVoxels>
  bool cube(Node* node, bool fresh, uint64_t passed, uint64_t hit, uint64_t& occupied);

  /// Updates below a childless node in this scan.
  struct Below {
    bool passed;  ///< some voxel
    bool hit;
    bool all;  ///< each voxel is one or the other
  };
  std::optional<bool> updateWhole(Node* node, bool fresh, const Below& below);
  bool finish(Node* node, bool opened, bool changed);

  octomap::OcTree* tree_ = nullptr;
  std::vector<Entry> order_;
};

}  // namespace tread::mapping
