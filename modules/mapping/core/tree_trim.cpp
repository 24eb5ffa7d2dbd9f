// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/mapping/core/tree_trim.hpp"

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

}  // namespace

void trimTree(OcTree& tree, const KeyBox& box) {
  if (tree.getRoot() == nullptr) return;
  const Cube all{{0, 0, 0}, 1 << kTreeDepth};
  if (!trim(tree, tree.getRoot(), 0, all, box)) tree.clear();
}

}  // namespace tread::mapping
