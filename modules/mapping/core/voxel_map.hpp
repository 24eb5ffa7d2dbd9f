// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <octomap/OcTree.h>

#include "common/grid/grid.hpp"
#include "modules/mapping/core/ray_grid.hpp"
#include "modules/mapping/core/tree_update.hpp"

namespace tread::mapping {

/// A square of elements with indices fixed in map; elements that leave it are forgotten, new ones
/// are initialised.
template <class Element>
class Window {
 public:
  explicit Window(int side)
      : side_(side), elements_(static_cast<size_t>(side) * static_cast<size_t>(side)) {}

  int side() const { return side_; }
  CellIndex lower() const { return lower_; }
  size_t size() const { return elements_.size(); }
  bool contains(CellIndex index) const {
    return index.x >= lower_.x && index.y >= lower_.y && index.x < lower_.x + side_ &&
           index.y < lower_.y + side_;
  }
  size_t offset(CellIndex index) const {
    return static_cast<size_t>(index.y - lower_.y) * static_cast<size_t>(side_) +
           static_cast<size_t>(index.x - lower_.x);
  }
  CellIndex indexOf(size_t offset) const {
    const auto side = static_cast<size_t>(side_);
    return {lower_.x + static_cast<int>(offset % side), lower_.y + static_cast<int>(offset / side)};
  }
  Element& operator[](size_t offset) { return elements_[offset]; }
  const Element& operator[](size_t offset) const { return elements_[offset]; }
  Element& at(CellIndex index) { return elements_[offset(index)]; }
  const Element& at(CellIndex index) const { return elements_[offset(index)]; }

  /// Keeps the elements in both the old and the new window.
  void moveTo(CellIndex lower) {
    Window moved(side_);
    moved.lower_ = lower;
    const int x_from = std::max(lower.x, lower_.x);
    const int x_to = std::min(lower.x, lower_.x) + side_;
    const int y_to = std::min(lower.y, lower_.y) + side_;
    for (int y = std::max(lower.y, lower_.y); y < y_to && x_from < x_to; ++y)
      std::copy_n(elements_.begin() + static_cast<std::ptrdiff_t>(offset({x_from, y})),
                  x_to - x_from,
                  moved.elements_.begin() + static_cast<std::ptrdiff_t>(moved.offset({x_from, y})));
    *this = std::move(moved);
  }

 private:
  int side_;
  CellIndex lower_;
  std::vector<Element> elements_;
};

/// Voxels by their keys, both corners included.
struct KeyBox {
  octomap::OcTreeKey low;
  octomap::OcTreeKey high;
};

/// Removes every leaf outside of a box; the rest stays pruned as before, inner nodes up to date.
/** Own descent, because the library has none: its deleteNode() aborts as soon as it removes the
 * last child of an inner node (the node's array of children stays allocated, and its destructor
 * asserts that there is none). Only pruneNode() frees that array, and only with eight equal
 * children. */
void trimTree(octomap::OcTree& tree, const KeyBox& box);

/// Index of the lowest set bit; at least one must be set.
inline int lowestBit(uint64_t bits) {
  return __builtin_ctzll(bits);
}

/// How evidence about a voxel accumulates; probabilities of being occupied (OctoMap's sensor
/// model).
struct VoxelConfig {
  double cell_size = 0.1;  ///< [m]
  double hit = 0.80;       ///< after one hit
  double miss = 0.40;      ///< after one passing beam
  double clamp_min = 0.12;
  double clamp_max = 0.88;  ///< with this and `miss`, five passing scans clear any voxel
};

/// Number of voxels in a column: the number of bits of a word.
inline constexpr int kColumnHeight = 64;

/// State of one column of voxels in the tree: bit i stands for the voxel lower_z + i.
struct Column {
  uint64_t known = 0;     ///< some beam ended in it or passed it
  uint64_t occupied = 0;  ///< more likely occupied than not

  uint64_t free() const { return known & ~occupied; }
};

/// A beam in map.
struct Ray {
  Eigen::Vector3d from;  ///< p_map [m]
  Eigen::Vector3d to;    ///< p_map of the return, or the end of the observed free space [m]
  bool hit = false;
};

/// Rolling octomap::OcTree with a bit image of its leaves, column by column.
/** The tree holds the evidence, the image its classification: both always agree, and no part of the
 * tree is outside of the window. The tree is pruned and its inner nodes are up to date. */
class VoxelMap {
 public:
  /// `side_cells`: a multiple of kBlockSide.
  VoxelMap(const VoxelConfig& config, int side_cells);
  VoxelMap(const VoxelMap&) = delete;
  VoxelMap& operator=(const VoxelMap&) = delete;

  /// Moves the window, given its lower left column and its lowest voxel as indices fixed in map,
  /// multiples of kBlockSide.
  void moveTo(CellIndex lower, int lower_z);

  /// Takes the rays of one scan; hits override passing beams, each voxel counts once.
  /** Gives the same tree as octomap::OcTree::insertPointCloud() within the window, with lazy_eval =
   * false. The only function that writes to the tree. */
  void insert(const std::vector<Ray>& rays);

  /// Columns that the last insert() passed or hit.
  const std::vector<size_t>& touched() const { return touched_; }
  /// Columns in which the last insert() changed known or occupied.
  const std::vector<size_t>& changed() const { return changed_; }

  const Window<Column>& columns() const { return columns_; }
  int lowerZ() const { return lower_z_; }
  const octomap::OcTree& tree() const { return tree_; }

 private:
  octomap::OcTreeKey keyOf(CellIndex column, int bit) const;
  void takeBlock(const VoxelBlock& block);
  void takeColumn(size_t offset, uint64_t seen, uint64_t occupied);

  octomap::OcTree tree_;
  Window<Column> columns_;
  int lower_z_ = 0;
  RayGrid grid_;
  TreeUpdate update_;
  /// Whether a column is among the touched and the changed ones.
  struct Listed {
    bool touched = false;
    bool changed = false;
  };
  std::vector<Listed> listed_;  // for each column
  std::vector<size_t> touched_;
  std::vector<size_t> changed_;
};

}  // namespace tread::mapping
