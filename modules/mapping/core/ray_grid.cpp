// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/mapping/core/ray_grid.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace tread::mapping {
namespace {

using Key = std::array<int, 3>;

constexpr int kWordBits = 64;
constexpr int kBlocksPerWord = kWordBits / kBlockSide;

/// The four bits of half a row of voxels, in their places in a 2 x 2 x 2 cube of 2 x 2 x 2 voxels.
constexpr std::array<uint64_t, 16> halfRows() {
  std::array<uint64_t, 16> rows{};
  for (unsigned x = 0; x < 16; ++x) rows[x] = (x & 3u) | uint64_t{x & 12u} << 6;
  return rows;
}
constexpr std::array<uint64_t, 16> kHalfRows = halfRows();

Key keyOf(const octomap::OcTreeKey& key) {
  return {key[0], key[1], key[2]};
}

}  // namespace

struct RayGrid::Step {
  Key key{};             // updated only outside of the box
  int64_t bit = 0;       // of the voxel
  int64_t last_bit = 0;  // of the voxel in which the beam ends
  Key last{};
  std::array<int, 3> direction{};    // -1, 0, 1
  std::array<int64_t, 3> strides{};  // [bits] of a step along each axis
  std::array<double, 3> next{};      // [m] along the beam to the next border of each axis
  std::array<double, 3> between{};   // [m] from one border to the next
  double length = 0.0;               // [m]
};

RayGrid::RayGrid(const Key& sides) : sides_(sides) {
  for (const int side : sides)
    if (side <= 0 || side % kBlockSide != 0)
      throw std::invalid_argument("ray grid: sides must be positive multiples of 8 voxels");
  // Rows begin with a word, so that eight blocks can be processed together.
  const int64_t row = (sides[0] + kWordBits - 1) / kWordBits * kWordBits;
  strides_ = {1, row, row * sides[1]};
  passed_.resize(static_cast<size_t>(strides_[2] * sides[2] / kWordBits));
  hit_.resize(passed_.size());
  marked_low_ = sides_;
  marked_high_ = {-1, -1, -1};
}

void RayGrid::moveTo(const Key& low) {
  takeBlocks();
  low_ = low;
}

int64_t RayGrid::bitOf(const Key& key) const {
  int64_t bit = 0;
  for (size_t axis = 0; axis < 3; ++axis) bit += (key[axis] - low_[axis]) * strides_[axis];
  return bit;
}

bool RayGrid::contains(const Key& key) const {
  for (size_t axis = 0; axis < 3; ++axis)
    if (key[axis] < low_[axis] || key[axis] >= low_[axis] + sides_[axis]) return false;
  return true;
}

/// Rounding may extend a beam one voxel beyond its end.
void RayGrid::extendTo(const Key& key) {
  for (size_t axis = 0; axis < 3; ++axis) {
    const int at = key[axis] - low_[axis];
    marked_low_[axis] = std::min(marked_low_[axis], std::clamp(at - 1, 0, sides_[axis] - 1));
    marked_high_[axis] = std::max(marked_high_[axis], std::clamp(at + 1, 0, sides_[axis] - 1));
  }
}

void RayGrid::trace(const octomap::OcTree& tree, const octomap::point3d& from,
                    const octomap::point3d& to, bool hit) {
  octomap::OcTreeKey first_key;
  octomap::OcTreeKey last_key;
  const bool ends = tree.coordToKeyChecked(to, last_key);
  if (!ends || !tree.coordToKeyChecked(from, first_key)) return;
  Step step;
  step.key = keyOf(first_key);
  step.last = keyOf(last_key);
  extendTo(step.key);
  extendTo(step.last);
  if (hit && contains(step.last)) mark(hit_, bitOf(step.last));
  if (step.key == step.last) return;
  octomap::point3d direction = to - from;
  const auto length = static_cast<float>(direction.norm());
  direction /= length;
  step.length = static_cast<double>(length);
  bool inside = true;
  for (unsigned i = 0; i < 3; ++i) {
    step.direction[i] = (direction(i) > 0.0F) - (direction(i) < 0.0F);
    step.strides[i] = step.direction[i] * strides_[i];
    step.next[i] = step.between[i] = std::numeric_limits<double>::max();
    // A beam is inside if it stays in the box even when it goes one voxel too far.
    const int nearest = std::min(step.key[i], step.last[i]) - 1;
    const int farthest = std::max(step.key[i], step.last[i]) + 1;
    inside = inside && nearest >= low_[i] && farthest < low_[i] + sides_[i];
    if (step.direction[i] == 0) continue;
    double border = tree.keyToCoord(first_key[i]);
    border +=
        static_cast<double>(static_cast<float>(step.direction[i] * tree.getResolution() * 0.5));
    step.next[i] = (border - static_cast<double>(from(i))) / static_cast<double>(direction(i));
    step.between[i] = tree.getResolution() / std::abs(static_cast<double>(direction(i)));
  }
  step.bit = bitOf(step.key);
  step.last_bit = bitOf(step.last);
  if (inside)
    walk<true>(step);
  else
    walk<false>(step);
}

/// Inside, a voxel's bit gives its position. Marks have the type of the strides, which the compiler
/// would reload after each: so a step is kept in local variables.
template <bool kInside>
void RayGrid::walk(Step& step) {
  uint64_t* const passed = passed_.data();
  const auto [stride_x, stride_y, stride_z] = step.strides;
  const auto [between_x, between_y, between_z] = step.between;
  auto [next_x, next_y, next_z] = step.next;
  const int64_t last_bit = step.last_bit;
  int64_t bit = step.bit;
  // The first step is taken for any length of the beam.
  double most = std::numeric_limits<double>::max();
  // Marks the voxel, leaves it along an axis and returns whether the beam continues.
  const auto leave = [&](size_t axis, int64_t stride, double& next, double between) {
    if (next > most) return false;
    if (kInside || contains(step.key)) passed[bit >> 6] |= uint64_t{1} << (bit & 63);
    bit += stride;
    next += between;
    most = step.length;
    if constexpr (kInside) return bit != last_bit;
    step.key[axis] += step.direction[axis];
    return step.key != step.last;
  };
  bool goes_on = true;
  while (goes_on) {
    if (next_x < next_y) {
      goes_on = next_x < next_z ? leave(0, stride_x, next_x, between_x)
                                : leave(2, stride_z, next_z, between_z);
    } else {
      goes_on = next_y < next_z ? leave(1, stride_y, next_y, between_y)
                                : leave(2, stride_z, next_z, between_z);
    }
  }
}

std::vector<VoxelBlock>& RayGrid::takeBlocks() {
  blocks_.clear();
  if (marked_high_[0] < 0) return blocks_;
  for (int z = marked_low_[2] / kBlockSide; z <= marked_high_[2] / kBlockSide; ++z)
    for (int y = marked_low_[1] / kBlockSide; y <= marked_high_[1] / kBlockSide; ++y) takeRow(y, z);
  marked_low_ = sides_;
  marked_high_ = {-1, -1, -1};
  return blocks_;
}

/// Processes a row of blocks, eight of them together, and clears it.
void RayGrid::takeRow(int block_y, int block_z) {
  const int64_t row_words = strides_[1] / kWordBits;
  const int64_t slice_words = strides_[2] / kWordBits;
  const int64_t first = (block_z * slice_words + block_y * row_words) * kBlockSide;
  for (int word = marked_low_[0] / kWordBits; word <= marked_high_[0] / kWordBits; ++word) {
    uint64_t passed = 0;
    uint64_t hit = 0;
    for (int z = 0; z < kBlockSide; ++z)
      for (int y = 0; y < kBlockSide; ++y) {
        const auto at = static_cast<size_t>(first + z * slice_words + y * row_words + word);
        passed |= passed_[at];
        hit |= hit_[at];
      }
    if ((passed | hit) == 0) continue;
    for (int block = 0; block < kBlocksPerWord; ++block) {
      const unsigned shift = static_cast<unsigned>(block * kBlockSide);
      if (((passed | hit) >> shift & 0xFFu) == 0) continue;
      takeBlock({word * kBlocksPerWord + block, block_y, block_z}, (hit >> shift & 0xFFu) != 0);
    }
    for (int z = 0; z < kBlockSide; ++z)
      for (int y = 0; y < kBlockSide; ++y) {
        const auto at = static_cast<size_t>(first + z * slice_words + y * row_words + word);
        passed_[at] = hit_[at] = 0;
      }
  }
}

void RayGrid::takeBlock(const Key& block, bool any_hit) {
  VoxelBlock& taken = blocks_.emplace_back();
  int64_t bit = 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    taken.low[axis] = low_[axis] + block[axis] * kBlockSide;
    bit += block[axis] * kBlockSide * strides_[axis];
  }
  gather(passed_, bit, taken.passed);
  if (!any_hit) return;
  gather(hit_, bit, taken.hit);
  for (size_t i = 0; i < taken.hit.size(); ++i) taken.passed[i] &= ~taken.hit[i];
}

/// Reorders the rows of a block to the octree's order.
void RayGrid::gather(const std::vector<uint64_t>& words, int64_t bit, BlockBits& bits) const {
  for (unsigned z = 0; z < kBlockSide; ++z)
    for (unsigned y = 0; y < kBlockSide; ++y) {
      const int64_t at = bit + z * strides_[2] + y * strides_[1];
      const uint64_t row = words[static_cast<size_t>(at >> 6)] >> (at & 63) & 0xFFu;
      if (row == 0) continue;
      const unsigned cube = (y & 1u) << 1 | (z & 1u) << 2 | (y & 2u) << 3 | (z & 2u) << 4;
      const unsigned child = (y & 4u) >> 1 | (z & 4u);
      bits[child] |= kHalfRows[row & 15u] << cube;
      bits[child + 1] |= kHalfRows[row >> 4] << cube;
    }
}

}  // namespace tread::mapping
