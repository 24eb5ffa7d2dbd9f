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

/// Returns whether anything is left below the node.
bool trim(OcTree& tree, OcTreeNode* node, unsigned depth, const Cube& cube, const KeyBox& box) {
  const Overlap overlap = overlapOf(cube, box);
  if (overlap != Overlap::kPartly) return overlap == Overlap::kInside;
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
  return any_left;
}

/// OctoMap numbers voxels from here: this key holds [0, cell_size).
constexpr int kKeyOfZero = 32768;

octomap::point3d point(const Eigen::Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

/// The bits of a column after its lowest voxel has moved up by `steps` (down if negative).
uint64_t shifted(uint64_t bits, int steps) {
  if (steps >= kColumnHeight || steps <= -kColumnHeight) return 0;
  return steps >= 0 ? bits >> steps : bits << -steps;
}

}  // namespace

void trimTree(OcTree& tree, const KeyBox& box) {
  if (tree.getRoot() == nullptr) return;
  const Cube all{{0, 0, 0}, 1 << kTreeDepth};
  if (!trim(tree, tree.getRoot(), 0, all, box)) tree.clear();
}

VoxelMap::VoxelMap(const VoxelConfig& config, int side_cells)
    : tree_(config.cell_size), columns_(side_cells), marks_(columns_.size()) {
  tree_.setProbHit(config.hit);
  tree_.setProbMiss(config.miss);
  tree_.setClampingThresMin(config.clamp_min);
  tree_.setClampingThresMax(config.clamp_max);
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
    column = {shifted(column.known, steps), shifted(column.occupied, steps),
              shifted(column.settled, steps)};
  }
  const int last = columns_.side() - 1;
  trimTree(tree_, {keyOf(lower, 0), keyOf({lower.x + last, lower.y + last}, kColumnHeight - 1)});
}

void VoxelMap::mark(const octomap::OcTreeKey& key, uint64_t Marks::*kind) {
  const CellIndex index{key[0] - kKeyOfZero, key[1] - kKeyOfZero};
  const int bit = key[2] - kKeyOfZero - lower_z_;
  if (bit < 0 || bit >= kColumnHeight || !columns_.contains(index)) return;
  const size_t offset = columns_.offset(index);
  Marks& marks = marks_[offset];
  if ((marks.passed | marks.hit) == 0) touched_.push_back(offset);
  marks.*kind |= uint64_t{1} << bit;
}

void VoxelMap::insert(const std::vector<Ray>& rays) {
  touched_.clear();
  changed_.clear();
  octomap::OcTreeKey end;
  for (const Ray& ray : rays) {
    if (!tree_.computeRayKeys(point(ray.from), point(ray.to), keys_)) continue;
    for (const octomap::OcTreeKey& key : keys_) mark(key, &Marks::passed);
    if (ray.hit && tree_.coordToKeyChecked(point(ray.to), end)) mark(end, &Marks::hit);
  }
  for (const size_t offset : touched_) apply(offset);
}

void VoxelMap::apply(size_t offset) {
  Column& column = columns_[offset];
  Marks& marks = marks_[offset];
  const Column before = column;
  update(offset, marks.hit & ~(before.settled & before.occupied), true);
  update(offset, marks.passed & ~marks.hit & ~(before.settled & before.free()), false);
  marks = {};
  if (column.known != before.known || column.occupied != before.occupied)
    changed_.push_back(offset);
}

void VoxelMap::update(size_t offset, uint64_t bits, bool hit) {
  Column& column = columns_[offset];
  const CellIndex index = columns_.indexOf(offset);
  for (; bits != 0; bits &= bits - 1) {
    const uint64_t bit = bits & (~bits + 1);
    const octomap::OcTreeNode* node = tree_.updateNode(keyOf(index, lowestBit(bits)), hit, true);
    const bool occupied = tree_.isNodeOccupied(node);
    const float value = node->getLogOdds();
    const bool settled = occupied ? value >= tree_.getClampingThresMaxLog()
                                  : value <= tree_.getClampingThresMinLog();
    column.known |= bit;
    column.occupied = occupied ? column.occupied | bit : column.occupied & ~bit;
    column.settled = settled ? column.settled | bit : column.settled & ~bit;
  }
}

}  // namespace tread::mapping
