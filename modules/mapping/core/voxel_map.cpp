// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/mapping/core/voxel_map.hpp"

namespace tread::mapping {
namespace {

using octomap::OcTree;
using octomap::OcTreeNode;

constexpr unsigned kTreeDepth = 16;

/// A node's cube in key space.
struct Cube {
  int low[3];
  int side;

  Cube child(unsigned i) const {
    const int half = side / 2;
    return {{low[0] + ((i & 1u) != 0 ? half : 0), low[1] + ((i & 2u) != 0 ? half : 0),
             low[2] + ((i & 4u) != 0 ? half : 0)},
            half};
  }
};

enum class Overlap { kOutside, kInside, kPartly };

Overlap overlapOf(const Cube& cube, const KeyBox& box) {
  bool inside = true;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const int last = cube.low[axis] + cube.side - 1;
    if (last < box.low[axis] || cube.low[axis] > box.high[axis]) return Overlap::kOutside;
    inside = inside && cube.low[axis] >= box.low[axis] && last <= box.high[axis];
  }
  return inside ? Overlap::kInside : Overlap::kPartly;
}

/// Makes an inner node childless, its array of children included.
void makeChildless(OcTree& tree, OcTreeNode* node, unsigned depth) {
  if (depth == kTreeDepth) return;
  for (unsigned i = 0; i < 8; ++i) {
    if (!tree.nodeChildExists(node, i)) {
      tree.createNodeChild(node, i)->setLogOdds(0.0f);
      continue;
    }
    OcTreeNode* child = tree.getNodeChild(node, i);
    makeChildless(tree, child, depth + 1);
    child->setLogOdds(0.0f);
  }
  tree.pruneNode(node);
}

/// Returns whether anything remains below the node.
bool trim(OcTree& tree, OcTreeNode* node, unsigned depth, const Cube& cube, const KeyBox& box) {
  const Overlap overlap = overlapOf(cube, box);
  if (overlap != Overlap::kPartly) return overlap == Overlap::kInside;
  if (!tree.nodeHasChildren(node)) tree.expandNode(node);
  bool any_left = false;
  for (unsigned i = 0; i < 8; ++i) {
    if (!tree.nodeChildExists(node, i)) continue;
    OcTreeNode* child = tree.getNodeChild(node, i);
    if (trim(tree, child, depth + 1, cube.child(i), box)) {
      any_left = true;
      continue;
    }
    makeChildless(tree, child, depth + 1);
    tree.deleteNodeChild(node, i);
  }
  if (any_left) node->updateOccupancyChildren();
  return any_left;
}

/// OctoMap's voxel index of the origin: this key covers [0, cell_size).
constexpr int kKeyOfZero = 32768;

octomap::point3d point(const Eigen::Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

/// The bits of a column after its lowest voxel has moved up by `steps` (down if negative).
uint64_t shifted(uint64_t bits, int steps) {
  if (steps >= kColumnHeight || steps <= -kColumnHeight) return 0;
  return steps >= 0 ? bits >> steps : bits << -steps;
}

/// The eight voxels of a block above each other at x, y (0..7), the lowest one first.
uint64_t columnOf(const BlockBits& bits, unsigned x, unsigned y) {
  const unsigned child = (x & 4u) >> 2 | (y & 4u) >> 1;
  const unsigned cube = (x & 1u) | (y & 1u) << 1 | (x & 2u) << 2 | (y & 2u) << 3;
  const auto half = [&](uint64_t word) {
    word >>= cube;
    return (word & 1u) | (word >> 3 & 2u) | (word >> 30 & 4u) | (word >> 33 & 8u);
  };
  return half(bits[child]) | half(bits[child + 4]) << 4;
}

}  // namespace

void trimTree(OcTree& tree, const KeyBox& box) {
  if (tree.getRoot() == nullptr) return;
  const Cube all{{0, 0, 0}, 1 << kTreeDepth};
  if (!trim(tree, tree.getRoot(), 0, all, box)) tree.clear();
}

VoxelMap::VoxelMap(const VoxelConfig& config, int side_cells)
    : tree_(config.cell_size),
      columns_(side_cells),
      grid_({side_cells, side_cells, kColumnHeight}),
      listed_(columns_.size()) {
  tree_.setProbHit(config.hit);
  tree_.setProbMiss(config.miss);
  tree_.setClampingThresMin(config.clamp_min);
  tree_.setClampingThresMax(config.clamp_max);
  moveTo({0, 0}, 0);
}

octomap::OcTreeKey VoxelMap::keyOf(CellIndex column, int bit) const {
  const auto key = [](int index) { return static_cast<octomap::key_type>(index + kKeyOfZero); };
  return {key(column.x), key(column.y), key(lower_z_ + bit)};
}

void VoxelMap::moveTo(CellIndex lower, int lower_z) {
  const int steps = lower_z - lower_z_;
  columns_.moveTo(lower);
  lower_z_ = lower_z;
  for (size_t i = 0; i < columns_.size(); ++i) {
    Column& column = columns_[i];
    column = {shifted(column.known, steps), shifted(column.occupied, steps)};
  }
  const int last = columns_.side() - 1;
  trimTree(tree_, {keyOf(lower, 0), keyOf({lower.x + last, lower.y + last}, kColumnHeight - 1)});
  grid_.moveTo({lower.x + kKeyOfZero, lower.y + kKeyOfZero, lower_z + kKeyOfZero});
}

void VoxelMap::insert(const std::vector<Ray>& rays) {
  for (const size_t offset : touched_) listed_[offset] = {};
  touched_.clear();
  changed_.clear();
  for (const Ray& ray : rays) grid_.trace(tree_, point(ray.from), point(ray.to), ray.hit);
  std::vector<VoxelBlock>& blocks = grid_.takeBlocks();
  update_(tree_, blocks);
  for (const VoxelBlock& block : blocks) takeBlock(block);
}

void VoxelMap::takeBlock(const VoxelBlock& block) {
  const CellIndex lower{block.low[0] - kKeyOfZero, block.low[1] - kKeyOfZero};
  const auto shift = static_cast<unsigned>(block.low[2] - kKeyOfZero - lower_z_);
  for (unsigned y = 0; y < kBlockSide; ++y)
    for (unsigned x = 0; x < kBlockSide; ++x) {
      const uint64_t seen = columnOf(block.passed, x, y) | columnOf(block.hit, x, y);
      if (seen == 0) continue;
      const size_t offset =
          columns_.offset({lower.x + static_cast<int>(x), lower.y + static_cast<int>(y)});
      takeColumn(offset, seen << shift, columnOf(block.occupied, x, y) << shift);
    }
}

void VoxelMap::takeColumn(size_t offset, uint64_t seen, uint64_t occupied) {
  Column& column = columns_[offset];
  Listed& listed = listed_[offset];
  const Column before = column;
  column.known |= seen;
  column.occupied = (column.occupied & ~seen) | occupied;
  if (!listed.touched) touched_.push_back(offset);
  listed.touched = true;
  if (column.known == before.known && column.occupied == before.occupied) return;
  if (!listed.changed) changed_.push_back(offset);
  listed.changed = true;
}

}  // namespace tread::mapping
