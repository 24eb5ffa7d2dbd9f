// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/mapping/core/tree_update.hpp"

#include <algorithm>

namespace tread::mapping {
namespace {

/// Depth at which a node is as large as a block; a voxel's is 16.
constexpr unsigned kBlockDepth = 13;

/// The 13 bits of a block's number, two zeros between each.
uint64_t spread(int block) {
  uint64_t bits = 0;
  for (unsigned i = 0; i < kBlockDepth; ++i)
    bits |= (static_cast<uint64_t>(block) >> i & 1u) << (3 * i);
  return bits;
}

uint64_t mortonOf(const VoxelBlock& block) {
  return spread(block.low[0] / kBlockSide) | spread(block.low[1] / kBlockSide) << 1 |
         spread(block.low[2] / kBlockSide) << 2;
}

/// For the first observed voxel: the nine bits of its index in the block are x, y and z in turn.
octomap::OcTreeKey firstKeyOf(const VoxelBlock& block) {
  size_t word = 0;
  while (block.seen(word) == 0) ++word;
  const unsigned code =
      static_cast<unsigned>(word) << 6 | static_cast<unsigned>(__builtin_ctzll(block.seen(word)));
  octomap::OcTreeKey key;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const unsigned bits = code >> axis;
    const unsigned step = (bits & 1u) | (bits >> 2 & 2u) | (bits >> 4 & 4u);
    key[axis] = static_cast<octomap::key_type>(static_cast<unsigned>(block.low[axis]) + step);
  }
  return key;
}

}  // namespace

void TreeUpdate::operator()(octomap::OcTree& tree, std::vector<VoxelBlock>& blocks) {
  if (blocks.empty()) return;
  tree_ = &tree;
  order_.clear();
  for (VoxelBlock& block : blocks) order_.emplace_back(mortonOf(block), &block);
  std::sort(order_.begin(), order_.end());
  // A tree creates only its own root; neutral evidence for a voxel that is updated anyway does it.
  if (tree.getRoot() == nullptr) tree.updateNode(firstKeyOf(*order_.front().second), 0.0F);
  inner(tree.getRoot(), false, 0, order_.data(), order_.data() + order_.size());
}

/// Returns whether the node has changed, as do the other functions.
bool TreeUpdate::inner(Node* node, bool fresh, unsigned depth, const Entry* first,
                       const Entry* last) {
  if (depth == kBlockDepth) return block(node, fresh, *first->second);
  const bool pruned = !fresh && !tree_->nodeHasChildren(node);
  if (pruned) tree_->expandNode(node);
  const unsigned shift = 3 * (kBlockDepth - 1 - depth);
  bool changed = false;
  while (first != last) {
    const auto child = static_cast<unsigned>(first->first >> shift & 7u);
    const Entry* end = first + 1;
    while (end != last && (end->first >> shift & 7u) == child) ++end;
    const bool made = !tree_->nodeChildExists(node, child);
    Node* const below =
        made ? tree_->createNodeChild(node, child) : tree_->getNodeChild(node, child);
    changed = inner(below, made, depth + 1, first, end) || changed;
    first = end;
  }
  return finish(node, pruned, changed);
}

bool TreeUpdate::block(Node* node, bool fresh, VoxelBlock& block) {
  Below below{false, false, true};
  for (size_t i = 0; i < block.hit.size(); ++i) {
    below.passed = below.passed || block.passed[i] != 0;
    below.hit = below.hit || block.hit[i] != 0;
    below.all = below.all && block.seen(i) == ~uint64_t{0};
  }
  const bool childless = fresh || !tree_->nodeHasChildren(node);
  if (childless) {
    if (const auto changed = updateWhole(node, fresh, below)) {
      if (tree_->isNodeOccupied(node))
        for (size_t i = 0; i < block.hit.size(); ++i) block.occupied[i] = block.seen(i);
      return *changed;
    }
    if (!fresh) tree_->expandNode(node);
  }
  bool changed = false;
  for (unsigned i = 0; i < 8; ++i) {
    if (block.seen(i) == 0) continue;
    const bool made = !tree_->nodeChildExists(node, i);
    Node* const child = made ? tree_->createNodeChild(node, i) : tree_->getNodeChild(node, i);
    changed = cube<64>(child, made, block.passed[i], block.hit[i], block.occupied[i]) || changed;
  }
  return finish(node, childless && !fresh, changed);
}

/// The same for a node of this many voxels; `occupied`: as in VoxelBlock.
template <unsigned kVoxels>
bool TreeUpdate::cube(Node* node, bool fresh, uint64_t passed, uint64_t hit, uint64_t& occupied) {
  constexpr uint64_t kAll = ~uint64_t{0} >> (64 - kVoxels);
  const bool childless = kVoxels == 1 || fresh || !tree_->nodeHasChildren(node);
  if (childless) {
    const Below below{passed != 0, hit != 0, (passed | hit) == kAll};
    if (const auto changed = updateWhole(node, fresh, below)) {
      occupied = tree_->isNodeOccupied(node) ? passed | hit : 0;
      return *changed;
    }
  }
  bool changed = false;
  if constexpr (kVoxels > 1) {
    if (childless && !fresh) tree_->expandNode(node);
    constexpr unsigned kBelow = kVoxels / 8;
    constexpr uint64_t kMask = kAll >> (kVoxels - kBelow);
    for (unsigned i = 0; i < 8; ++i) {
      const uint64_t child_passed = passed >> (i * kBelow) & kMask;
      const uint64_t child_hit = hit >> (i * kBelow) & kMask;
      if ((child_passed | child_hit) == 0) continue;
      const bool made = !tree_->nodeChildExists(node, i);
      Node* const child = made ? tree_->createNodeChild(node, i) : tree_->getNodeChild(node, i);
      uint64_t now = 0;
      changed = cube<kBelow>(child, made, child_passed, child_hit, now) || changed;
      occupied |= now << (i * kBelow);
    }
  }
  return finish(node, childless && !fresh, changed);
}

/// Updates a childless node as one; nullopt if it needs children first.
std::optional<bool> TreeUpdate::updateWhole(Node* node, bool fresh, const Below& below) {
  if (below.passed && below.hit) return std::nullopt;
  const bool settled = below.hit ? node->getLogOdds() >= tree_->getClampingThresMaxLog()
                                 : node->getLogOdds() <= tree_->getClampingThresMinLog();
  if (settled && !fresh) return false;
  if (!below.all) return std::nullopt;
  tree_->updateNodeLogOdds(node, below.hit ? tree_->getProbHitLog() : tree_->getProbMissLog());
  return true;
}

/// `opened`: it was childless until now; without a change it becomes so again.
bool TreeUpdate::finish(Node* node, bool opened, bool changed) {
  if ((changed || opened) && !tree_->pruneNode(node)) node->updateOccupancyChildren();
  return changed;
}

}  // namespace tread::mapping
