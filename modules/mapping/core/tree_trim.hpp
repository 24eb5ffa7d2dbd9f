// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <octomap/OcTree.h>

namespace tread::mapping {

/// Voxels by their keys, both corners included.
struct KeyBox {
  octomap::OcTreeKey low;
  octomap::OcTreeKey high;
};

/// Removes every leaf outside of a box; leafs must be single voxels (nothing pruned).
/** Own descent, because the library has none: its deleteNode() aborts as soon as it takes the last
 *  child of an inner node (the node's array of children stays allocated, and its destructor asserts
 *  that there is none). Only pruneNode() frees that array, and only with eight equal children. */
void trimTree(octomap::OcTree& tree, const KeyBox& box);

}  // namespace tread::mapping
