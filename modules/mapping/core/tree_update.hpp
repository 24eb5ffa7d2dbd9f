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

/// Puts the blocks of one scan into an octree and says which of their voxels are occupied now.
/** The tree is the same, byte for byte, as after octomap::OcTree::updateNode(key, hit) for each
 *  voxel of the blocks, hits and misses in any order: pruned wherever eight children are equal,
 *  inner nodes up to date.
 *  1. Blocks in Morton order: the children of a node stand together, so one descent visits each
 *     node once and prunes it, or sets its value, when all its children are done.
 *  2. A childless node below which every voxel gets the same is updated itself: what eight equal
 *     children become when they are pruned. So seen free space costs no nodes.
 *  3. Nodes at the clamp of what they would get stay as they are, as in updateNode().
 *  Change detection of the tree is not served. Blocks are sorted; no block may come twice. */
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

  /// What a childless node has below it for this scan.
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
